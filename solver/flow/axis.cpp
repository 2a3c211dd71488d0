#include "solver/flow/axis.hpp"

#include <stdexcept>
#include <string>

namespace grainsweep::flow {

Axis::Axis(int cells, double low, double high, double clustering)
    : cells_(cells),
      mapped_(cells),
      low_(low),
      high_(high),
      clustering_(clustering),
      middle_(0.5 * (low + high)),
      half_(0.5 * (high - low)),
      tanh_(clustering > 0 ? std::tanh(clustering) : 1.0) {
    if (cells < 1) throw std::invalid_argument("an axis needs at least one cell, not " + std::to_string(cells));
    if (!(high > low)) throw std::invalid_argument("an axis must end above where it begins");
    if (!(clustering >= 0)) throw std::invalid_argument("the clustering of an axis must not be negative");
    const auto n = static_cast<std::size_t>(cells);
    faces_.resize(n + 3);
    for (int f = 1; f <= cells + 1; ++f) {
        const double s = 2.0 * (f - 1) / cells - 1.0;  // -1 ... 1, antisymmetric to the last bit
        const double t = clustering > 0 ? std::tanh(clustering * s) / tanh_ : s;
        faces_[static_cast<std::size_t>(f)] = middle_ + half_ * t;
    }
    faces_[1] = low;
    faces_[n + 1] = high;
    faces_[0] = low - (faces_[2] - low);
    faces_[n + 2] = high + (high - faces_[n]);
    for (std::size_t i = 0; i <= n + 1; ++i) {
        centres_.push_back(0.5 * (faces_[i] + faces_[i + 1]));
        widths_.push_back(faces_[i + 1] - faces_[i]);
    }
    measure();
}

/// Computes the distances and widths that follow from the cells.
void Axis::measure() {
    per_width_.clear();
    per_spacing_.assign(1, 0);
    for (const double width : widths_) per_width_.push_back(1 / width);
    for (int f = 1; f <= cells_ + 1; ++f) per_spacing_.push_back(1 / spacing(f));
    const double smallest = *std::min_element(widths_.begin(), widths_.end());
    const double bins = std::ceil(length() / smallest);
    bins_per_length_ = bins / length();
    first_cell_.clear();
    for (double bin = 0; bin < bins; ++bin) {
        const double from = low_ + bin / bins_per_length_ - 1e-9 * smallest;  // whatever rounding does to a position
        int cell = first_cell_.empty() ? 1 : first_cell_.back();
        while (cell < cells_ && from >= face(cell + 1)) ++cell;
        first_cell_.push_back(cell);
    }
}

Axis Axis::uniform(int cells, double low, double high) {
    return {cells, low, high, 0};
}

Axis Axis::clustered(int cells, double low, double high, double clustering) {
    return {cells, low, high, clustering};
}

Axis Axis::lower_half() const {
    if (cells_ % 2 != 0) throw std::invalid_argument("half an axis needs an even number of cells");
    Axis half = *this;
    half.cells_ = cells_ / 2;
    half.high_ = middle_;
    const auto n = static_cast<std::size_t>(half.cells_);
    half.faces_.resize(n + 3);
    half.centres_.resize(n + 2);
    half.widths_.resize(n + 2);
    half.measure();
    return half;
}

}  // namespace grainsweep::flow
