// Axis of a tensor-product grid: positions and widths of its cells.
//
// Uniform: x(s) = low + (high - low) s/n.
// Clustered towards both ends: x(s) = middle + (high - low)/2 tanh(c (2 s/n - 1))/tanh(c), s = 0 ... n,
// smooth, so that second-order differences stay second order (Vinokur 1983, doi 10.1016/0021-9991(83)90065-7).
//
// Indices: cells 1 ... n, 0 and n+1 are ghosts as wide as their neighbours; face f is the lower end of cell f,
// so faces are 1 ... n+1.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grainsweep::flow {

/// Position on an axis: its cell, and the distance from the lower face of the cell in cells, [0, 1].
struct Place {
    int cell = 1;
    double offset = 0;
};

class Axis {
public:
    /// Returns n >= 1 equal cells between low and high. Throws std::invalid_argument.
    [[nodiscard]] static Axis uniform(int cells, double low, double high);
    /// Returns cells that are narrower at both ends for clustering > 0; 0 is uniform. Throws std::invalid_argument.
    [[nodiscard]] static Axis clustered(int cells, double low, double high, double clustering);

    /// Returns the cells below the middle of an axis with an even number of cells; faces, centres and widths have the
    /// same bits. Throws std::invalid_argument.
    [[nodiscard]] Axis lower_half() const;

    [[nodiscard]] int cells() const { return cells_; }
    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const { return high_; }
    [[nodiscard]] double length() const { return high_ - low_; }
    [[nodiscard]] bool is_uniform() const { return clustering_ == 0; }

    [[nodiscard]] double face(int f) const { return faces_[static_cast<std::size_t>(f)]; }      ///< f = 0 ... n+2
    [[nodiscard]] double centre(int i) const { return centres_[static_cast<std::size_t>(i)]; }  ///< i = 0 ... n+1
    [[nodiscard]] double width(int i) const { return widths_[static_cast<std::size_t>(i)]; }    ///< i = 0 ... n+1
    /// Returns the distance between the two cell centres beside face f, f = 1 ... n+1.
    [[nodiscard]] double spacing(int f) const { return centre(f) - centre(f - 1); }

    /// Return the reciprocals of width and spacing, stored for interpolation.
    [[nodiscard]] double per_width(int i) const { return per_width_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] double per_spacing(int f) const { return per_spacing_[static_cast<std::size_t>(f)]; }

    /// Returns the cell of a position; positions outside, and NaN, get a cell at an end. A table replaces a logarithm:
    /// bins finer than the smallest cell store the first cell that they overlap.
    [[nodiscard]] int cell_at(double x) const {
        const double bin = (x - low_) * bins_per_length_;
        const auto last = static_cast<double>(first_cell_.size() - 1);
        int cell = first_cell_[bin > 0 ? static_cast<std::size_t>(bin < last ? bin : last) : 0];
        while (cell < cells_ && x >= face(cell + 1)) ++cell;
        return cell;
    }
    /// Returns the cell and smooth offset s of a position in [low, high]; positions outside get the nearest end.
    [[nodiscard]] Place locate(double x) const {
        const double t = std::clamp((x - middle_) / half_, -1.0, 1.0);
        const double in_cells = 0.5 * ((clustering_ > 0 ? unclustered(t) : t) + 1) * mapped_;
        // NaN also gives an existing cell.
        const int cell = in_cells < cells_ - 1 ? static_cast<int>(in_cells) : cells_ - 1;
        const double offset = in_cells - cell;
        return {cell + 1, offset >= 0 ? offset : 0};
    }

private:
    Axis(int cells, double low, double high, double clustering);
    void measure();

    // Returns artanh(t tanh c)/c, the inverse of the clustering.
    [[nodiscard]] double unclustered(double t) const {
        const double a = t * tanh_;
        return std::clamp(0.5 * std::log((1 + a) / (1 - a)) / clustering_, -1.0, 1.0);
    }

    int cells_;
    int mapped_;  // cells of the map between low and high: twice as many on a half axis
    double low_, high_, clustering_;
    double middle_, half_, tanh_;
    std::vector<double> faces_, centres_, widths_, per_width_, per_spacing_;
    double bins_per_length_ = 0;
    std::vector<int> first_cell_;  // of each bin
};

}  // namespace grainsweep::flow
