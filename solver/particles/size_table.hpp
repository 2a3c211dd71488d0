// Measured distribution of diameters (sieves, laser diffraction, image analysis), by number of particles.
//
// The text has a header, which names the second column, then one line per diameter, ascending, in m.
//     diameter,number_fraction      share of the particles that have this diameter: classes
//     diameter,volume_fraction      their share of the volume
//     diameter,number_below         share of the particles below this diameter, 0 to 1; uniform in d between two lines
//     diameter,volume_below         share of the volume below this diameter; uniform in d between two lines
//     diameter,area_fraction, area_below     likewise of the surface, which is proportional to d^2
// A class of volume share V and diameter d has a number share proportional to V/d^3. If the volume is uniform in d, the
// number of particles is proportional to d^-3: with x = d^-2 the inverse is x = x_0 - u (x_0 - x_1). If the surface is
// uniform in d, with x = 1/d likewise.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::particles {

class SizeTable {
public:
    /// Reads a table. Throws std::invalid_argument with one sentence if the text is no such table.
    [[nodiscard]] static SizeTable read(std::string_view csv);
    /// Returns the table with all diameters in units of `unit`.
    [[nodiscard]] SizeTable over(double unit) const;

    /// Returns the diameter below which the share u of all particles lies, 0 <= u < 1.
    [[nodiscard]] double diameter(double u) const;
    [[nodiscard]] double smallest() const { return pieces_.front().from; }
    [[nodiscard]] double largest() const { return pieces_.back().to; }
    /// Returns E[d^power] by number.
    [[nodiscard]] double moment(int power) const;
    /// Returns the share of all d^power below a diameter: of particles for 0, of volume for 3.
    [[nodiscard]] double share_below(double diameter, int power) const;
    /// Returns the diameter below which the share of all d^power lies, 0 <= share <= 1.
    [[nodiscard]] double quantile(double share, int power) const;
    /// Returns the part between two diameters, both included. Throws std::invalid_argument if it is empty.
    [[nodiscard]] SizeTable between(double low, double high) const;
    /// Returns the table as text for read(), with nine digits.
    [[nodiscard]] std::string text() const;

private:
    enum class Even { number, area, volume };  ///< quantity that is uniform in d within a piece
    struct Piece {
        double from = 0, to = 0;  ///< equal: a class
        double share = 0;         ///< by number
        Even even = Even::number;

        [[nodiscard]] double diameter(double u) const;
        [[nodiscard]] double moment(int power) const;
        /// Returns the part between two diameters; its share is 0 if it is empty.
        [[nodiscard]] Piece between(double low, double high) const;
    };

    std::vector<Piece> pieces_;
};

}  // namespace grainsweep::particles
