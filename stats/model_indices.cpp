#include "stats/model_indices.hpp"

#include "stats/confidence.hpp"
#include "stats/response/state.hpp"
#include "stats/sobol_sequence.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::size_t base_points = 2048, stretches = 8;

/// Base points: two halves of one Sobol sequence of twice the dimensions, its first point (a corner) left out.
struct Base {
    std::vector<double> a, b;
    std::size_t dimensions;

    /// A with the columns j (and k) of B.
    [[nodiscard]] std::vector<double> exchanged(std::size_t j, std::size_t k) const {
        std::vector<double> points = a;
        for (std::size_t i = 0; i < base_points; ++i)
            for (const std::size_t column : {j, k}) points[i * dimensions + column] = b[i * dimensions + column];
        return points;
    }
};

Base base_of(std::size_t d) {
    SobolSequence sequence(2 * d);
    Base base{{}, {}, d};
    const auto next = [&] { return sequence.next_fraction(); };
    for (std::size_t j = 0; j < 2 * d; ++j) (void)next();
    for (std::size_t i = 0; i < base_points; ++i) {
        for (std::size_t j = 0; j < d; ++j) base.a.push_back(next());
        for (std::size_t j = 0; j < d; ++j) base.b.push_back(next());
    }
    return base;
}

/// The model and its versions without one group each: values (points, 1 + groups).
class Versions {
public:
    Versions(const ResponseModel& model, std::span<const std::size_t> groups, const FeatureMap& features)
        : state_(model.state()), features_(features) {
        const auto& used = state_.quality.used;
        if (used.size() != static_cast<std::size_t>(state_.kriging.size()))
            throw std::invalid_argument("indices of a model: cases were added to it");
        std::vector<std::vector<Eigen::Index>> left_out(1);  // the first version has all
        for (std::size_t i = 0; i < used.size(); ++i) {
            if (!groups.empty() && used[i] >= groups.size())
                throw std::invalid_argument("indices of a model: one group is needed for each case");
            const std::size_t group = groups.empty() ? i * stretches / used.size() : groups[used[i]];
            left_out.resize(std::max(left_out.size(), group + 2));
            left_out[group + 1].push_back(static_cast<Eigen::Index>(i));
        }
        folds_ = response::leave_folds_out(state_.kriging, left_out);
    }

    [[nodiscard]] Eigen::MatrixXd at(const std::vector<double>& points, std::size_t factors) const {
        if (!features_) {
            // Factors in [0, 1] are features in their box.
            using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
            const Eigen::Map<const RowMajor> x(points.data(), static_cast<Eigen::Index>(points.size() / factors),
                                               static_cast<Eigen::Index>(factors));
            return responses(response::mapped(state_.kriging.h, x));
        }
        const std::vector<double> features = features_({points, factors});
        const Rows rows{features, static_cast<std::size_t>(state_.low.size())};
        return responses(response::mapped(state_.kriging.h, state_.in_box(rows)));
    }

private:
    /// Up to a factor and a constant, which no share of the variance knows.
    [[nodiscard]] Eigen::MatrixXd responses(const Eigen::MatrixXd& at) const {
        Eigen::MatrixXd z = folds_.predict(state_.kriging, at);
        if (state_.logarithm) z = (state_.scale * z.array()).exp();
        return z;
    }

    const ResponseModel::State& state_;
    const FeatureMap& features_;
    response::FoldWeights folds_;
};

/// Half the mean squared difference of every version.
Eigen::ArrayXd half_square(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
    return (x - y).array().square().colwise().mean().transpose() / 2;
}

/// Value of the whole model, half-width from those without a group.
SensitivityIndex index_of(const Eigen::ArrayXd& versions) {
    std::vector<double> without(versions.begin() + 1, versions.end());
    return {versions(0), jackknife_half_width(without)};
}

}  // namespace

ModelIndices model_indices(const ResponseModel& model, std::size_t factors, std::span<const std::size_t> groups,
                           const FeatureMap& features) {
    if (factors == 0 || (!features && factors != model.dimensions()))
        throw std::invalid_argument("indices of a model: factors and features are of different numbers");
    const Versions versions(model, groups, features);
    const Base base = base_of(factors);
    const Eigen::MatrixXd a = versions.at(base.a, factors), b = versions.at(base.b, factors);
    Eigen::MatrixXd both(a.rows() + b.rows(), a.cols());
    both << a, b;
    const Eigen::ArrayXd variance =
        (both.rowwise() - both.colwise().mean()).array().square().colwise().mean().transpose();
    ModelIndices result;
    std::vector<Eigen::ArrayXd> first;
    for (std::size_t j = 0; j < factors; ++j) {
        const Eigen::MatrixXd moved = versions.at(base.exchanged(j, j), factors);
        first.emplace_back(1 - half_square(b, moved) / variance);
        const Eigen::ArrayXd total = half_square(a, moved) / variance;
        result.first.push_back(index_of(first.back()));
        result.total.push_back(index_of(total));
        result.interactions.push_back(index_of(total - first.back()));
    }
    for (std::size_t j = 0; j < factors; ++j)
        for (std::size_t k = j + 1; k < factors; ++k) {
            const Eigen::MatrixXd moved = versions.at(base.exchanged(j, k), factors);
            result.pairs.push_back(index_of(1 - half_square(b, moved) / variance - first[j] - first[k]));
        }
    return result;
}

}  // namespace grainsweep::stats
