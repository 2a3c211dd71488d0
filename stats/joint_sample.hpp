// Rows of numbers, such as the draws of a posterior, as the image of the unit cube.
//
// The cube is divided in the order of the columns, as the conditional quantiles of Rosenblatt 1952 (Ann. Math. Statist.
// 23, 470-472) are taken: the rows sorted by the first column make m(1) parts, those of a part sorted by the second
// column make m(2) parts, and so on; a part of the last column is one row. With r rows in a part and c columns left
// m is the largest whole number with m^c <= r. Every row has a box of volume 1/rows. An integral over the cube is
// therefore the mean over the rows, and any dependence between the columns is kept.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::stats {

class JointSample {
public:
    /// Requires columns of one length, at least 1, of finite numbers.
    explicit JointSample(std::vector<std::vector<double>> columns);

    [[nodiscard]] std::size_t rows() const { return columns_.front().size(); }
    [[nodiscard]] std::size_t columns() const { return columns_.size(); }
    [[nodiscard]] std::span<const double> column(std::size_t k) const { return columns_[k]; }

    /// Returns the row whose box holds the point u of the cube, one coordinate per column.
    [[nodiscard]] std::size_t row_at(std::span<const double> u) const;
    /// Returns the middle of the box of the row with these values; of several equal rows the middle one. Empty if there
    /// is no such row.
    [[nodiscard]] std::optional<std::vector<double>> place_of(std::span<const double> values) const;

    /// Returns the quantile of one column alone: linear between the sorted values x(i) at (i - 1/2)/rows, constant at
    /// the ends. Its mean over u is the mean of the column.
    [[nodiscard]] double quantile(std::size_t column, double u) const;
    /// Returns u with quantile(column, u) = x; if there are several, their middle.
    [[nodiscard]] double cumulative(std::size_t column, double x) const;

    bool operator==(const JointSample& other) const { return columns_ == other.columns_; }

private:
    void divide(std::size_t begin, std::size_t end, std::size_t column);

    std::vector<std::vector<double>> columns_;
    std::vector<std::vector<double>> sorted_;  ///< each column by itself
    std::vector<std::size_t> order_;           ///< the rows in the order of their boxes
    std::vector<std::size_t> by_value_;        ///< places in order_, sorted by the values of their rows
};

/// A column of a sample that several factors may share.
struct SampleColumn {
    std::shared_ptr<const JointSample> sample;
    std::size_t column = 0;

    bool operator==(const SampleColumn& other) const {
        return column == other.column && (sample == other.sample || *sample == *other.sample);
    }
};

}  // namespace grainsweep::stats
