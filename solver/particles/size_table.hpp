// A measured distribution of diameters, as sieves, laser diffraction and image analysis give it, by number of
// particles.
//
// The text: a header that says what the second column is, then one line per diameter, ascending, in m.
//     diameter,number_fraction      share of the particles that have this diameter: classes
//     diameter,volume_fraction      their share of the volume
//     diameter,number_below         share of the particles below this diameter, from 0 to 1: between two lines as many
//                                   particles in every interval of the same length
//     diameter,volume_below         share of the volume below it: between two lines as much volume in every interval
// A class of volume share V and diameter d has a number share proportional to V/d^3. Where volume is even in d, the
// number of particles falls as d^-3: with x = d^-2 its inverse is x = x_0 - u (x_0 - x_1).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::particles {

class SizeTable {
public:
    /// Throws std::invalid_argument with one sentence where the text is no such table.
    [[nodiscard]] static SizeTable read(std::string_view csv);
    /// The same with all diameters in units of `unit`.
    [[nodiscard]] SizeTable over(double unit) const;

    /// Below which lies the share u of all particles, 0 <= u < 1.
    [[nodiscard]] double diameter(double u) const;
    [[nodiscard]] double smallest() const { return pieces_.front().from; }
    [[nodiscard]] double largest() const { return pieces_.back().to; }
    /// E[d^power] by number.
    [[nodiscard]] double moment(int power) const;
    /// Share of all d^power below a diameter: of particles for 0, of volume for 3.
    [[nodiscard]] double share_below(double diameter, int power) const;
    /// The diameter below which lies the share of all d^power, 0 <= share <= 1.
    [[nodiscard]] double quantile(double share, int power) const;
    /// What lies between two diameters, both included. Throws std::invalid_argument where that is nothing.
    [[nodiscard]] SizeTable between(double low, double high) const;
    /// The table as text that read() takes, with nine digits.
    [[nodiscard]] std::string text() const;

private:
    enum class Even { number, volume };  ///< what is the same in every interval of a piece
    struct Piece {
        double from = 0, to = 0;  ///< equal: a class
        double share = 0;         ///< by number
        Even even = Even::number;

        [[nodiscard]] double diameter(double u) const;
        [[nodiscard]] double moment(int power) const;
        /// What lies between two diameters; its share is 0 where that is nothing.
        [[nodiscard]] Piece between(double low, double high) const;
    };

    std::vector<Piece> pieces_;
};

}  // namespace grainsweep::particles
