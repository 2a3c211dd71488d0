#include "stats/model_indices.hpp"

#include "stats/confidence.hpp"
#include "stats/random.hpp"
#include "stats/response/fit.hpp"
#include "stats/response/state.hpp"
#include "stats/sobol_sequence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::size_t scramblings = 8, points_each = 1024, base_points = scramblings * points_each, stretches = 8;

/// Seed from the responses: each campaign is integrated over other points, so that indices of different campaigns do
/// not share an error of integration.
std::uint64_t seed_of(const Eigen::VectorXd& values) {
    std::uint64_t seed = 0x696e6469636573;
    for (const double value : values) seed = splitmix64(seed ^ std::bit_cast<std::uint64_t>(value));
    return seed;
}

/// Base points A and B: the halves of a Sobol sequence of twice the dimensions, in independent scramblings one after
/// the other.
struct Base {
    std::vector<double> a, b;
    std::size_t dimensions;

    /// One half with some columns of the other.
    [[nodiscard]] std::vector<double> exchanged(std::vector<double> points, const std::vector<double>& from,
                                                std::initializer_list<std::size_t> columns) const {
        return exchanged(std::move(points), from, std::span(columns.begin(), columns.size()));
    }
    [[nodiscard]] std::vector<double> exchanged(std::vector<double> points, const std::vector<double>& from,
                                                std::span<const std::size_t> columns) const {
        for (std::size_t i = 0; i < base_points; ++i)
            for (const std::size_t column : columns) points[i * dimensions + column] = from[i * dimensions + column];
        return points;
    }
};

Base base_of(std::size_t d, std::uint64_t seed) {
    Base base{{}, {}, d};
    base.a.resize(base_points * d);
    base.b.resize(base_points * d);
    SobolSequence sequence(2 * d);
    std::vector<std::uint64_t> fractions(2 * d, 0);  // the point of index 0, with which the first 2^k are balanced
    for (std::size_t i = 0; i < points_each; ++i) {
        for (std::size_t s = 0; s < scramblings; ++s)
            for (std::size_t j = 0; j < 2 * d; ++j) {
                auto& half = j < d ? base.a : base.b;
                half[(s * points_each + i) * d + j % d] = scrambled_unit(fractions[j], bits_at(seed, s, j));
            }
        for (auto& fraction : fractions) fraction = sequence.next() >> (64U - scrambled_digits);
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

/// A part of the variance: (scramblings, versions).
using Part = Eigen::ArrayXXd;

Part means_of(const Eigen::ArrayXXd& each) {
    Part means(scramblings, each.cols());
    for (std::size_t s = 0; s < scramblings; ++s)
        means.row(static_cast<Eigen::Index>(s)) =
            each.middleRows(static_cast<Eigen::Index>(s * points_each), points_each).colwise().mean();
    return means;
}

/// What every index needs.
struct Whole {
    Part variance;
    double unseen;  ///< share of the variance of the mean response that is not in the model

    /// Value of the whole model; its half-width from models without a group, the scramblings and what is unseen.
    [[nodiscard]] SensitivityIndex index_of(const Part& part) const {
        const Eigen::ArrayXd all = variance.colwise().mean(), versions = part.colwise().mean().transpose() / all;
        const double value = versions(0);
        const std::vector<double> without(versions.begin() + 1, versions.end());
        const Eigen::ArrayXd integrals = (part.col(0) - value * variance.col(0)) / all(0);
        const auto groups = static_cast<double>(without.size());
        const double bias = (groups - 1) * (versions.tail(versions.size() - 1).mean() - value);
        const double by_points = student_half_width({integrals.data(), scramblings});
        return {value, std::hypot(std::hypot(jackknife_half_width(without), bias), std::hypot(by_points, unseen))};
    }
};

/// The last two lines of the header. Noise at the bound of the fit is none.
double unseen_share(const ResponseModel& model) {
    constexpr double chi_squared = 7.815;  // 95 % quantile with 3 degrees of freedom
    const ModelQuality& quality = model.quality();
    const auto& kriging = model.state().kriging;
    const bool scatters = kriging.h.noise() > 2 * response::smallest_noise;
    const double error = std::pow(quality.leave_one_out_error, 2);
    return std::hypot(std::max(0.0, error - (scatters ? quality.noise_share : 0)),
                      error * chi_squared / static_cast<double>(kriging.size()));
}

/// Means over the rows whose column lies in [low, high).
Part means_within(const Eigen::ArrayXXd& each, const Base& base, std::size_t column, double low, double high) {
    Part sums = Part::Zero(scramblings, each.cols());
    Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(scramblings);
    for (std::size_t i = 0; i < base_points; ++i) {
        const double u = base.a[i * base.dimensions + column];
        if (u < low || u >= high) continue;
        const auto s = static_cast<Eigen::Index>(i / points_each);
        sums.row(s) += each.row(static_cast<Eigen::Index>(i));
        counts(s) += 1;
    }
    return sums.colwise() / counts.max(1);
}

std::optional<ModelIndices::Noise> noise_of(const Versions& versions, const Base& base, const Whole& whole,
                                            const Eigen::MatrixXd& a, const FactorRoles& roles) {
    std::vector<std::size_t> noise, controls;
    for (std::size_t j = 0; j < roles.noise.size(); ++j) (roles.noise[j] ? noise : controls).push_back(j);
    if (noise.empty() || controls.empty()) return std::nullopt;
    const Eigen::MatrixXd moved = versions.at(base.exchanged(base.a, base.b, noise), base.dimensions);
    const Eigen::ArrayXXd each = (moved - a).array().square() / 2;
    ModelIndices::Noise found{whole.index_of(means_of(each)), {}};
    constexpr std::size_t eighths = 8;
    for (const auto j : controls) {
        const auto levels = j < roles.levels.size() ? roles.levels[j] : 0;
        const auto parts = static_cast<double>(levels > 0 ? levels : eighths);
        ModelIndices::Calmest least{j, 0, 1, found.total};
        for (double part = 0; part < parts; ++part) {
            const double from = part / parts, to = (part + 1) / parts;
            const auto left = whole.index_of(means_within(each, base, j, from, to));
            if (left.value < least.left.value) least = {j, from, to, left};
        }
        found.controls.push_back(least);
    }
    std::ranges::stable_sort(found.controls, {}, [](const auto& one) { return one.left.value; });
    return found;
}

}  // namespace

ModelIndices model_indices(const ResponseModel& model, std::size_t factors, std::span<const std::size_t> groups,
                           const FeatureMap& features, const FactorRoles& roles) {
    if (factors == 0 || (!features && factors != model.dimensions()))
        throw std::invalid_argument("indices of a model: factors and features are of different numbers");
    const Versions versions(model, groups, features);
    const Base base = base_of(factors, seed_of(model.state().kriging.values));
    const Eigen::MatrixXd a = versions.at(base.a, factors), b = versions.at(base.b, factors);
    const Eigen::RowVectorXd centre = (a.colwise().mean() + b.colwise().mean()) / 2;
    const Whole whole{means_of(((a.rowwise() - centre).array().square() + (b.rowwise() - centre).array().square()) / 2),
                      unseen_share(model)};
    ModelIndices result;
    std::vector<Eigen::MatrixXd> forth, back;  // f(A_j) - f(A), f(B_j) - f(B)
    for (std::size_t j = 0; j < factors; ++j) {
        forth.emplace_back(versions.at(base.exchanged(base.a, base.b, {j}), factors) - a);
        back.emplace_back(versions.at(base.exchanged(base.b, base.a, {j}), factors) - b);
        const Part first = means_of(-forth[j].array() * back[j].array() / 2);
        const Part interactions = means_of((forth[j] + back[j]).array().square() / 4);
        result.first.push_back(whole.index_of(first));
        result.total.push_back(whole.index_of(first + interactions));
        result.interactions.push_back(whole.index_of(interactions));
    }
    result.noise = noise_of(versions, base, whole, a, roles);
    const auto second_difference = [&](const std::vector<double>& points, const std::vector<double>& from,
                                       const Eigen::MatrixXd& at, const std::vector<Eigen::MatrixXd>& moved,
                                       std::size_t j, std::size_t k) {
        return Eigen::ArrayXXd(versions.at(base.exchanged(points, from, {j, k}), factors) - at - moved[j] - moved[k]);
    };
    for (std::size_t j = 0; j < factors; ++j)
        for (std::size_t k = j + 1; k < factors; ++k)
            result.pairs.push_back(whole.index_of(means_of(second_difference(base.a, base.b, a, forth, j, k) *
                                                           second_difference(base.b, base.a, b, back, j, k) / 4)));
    return result;
}

}  // namespace grainsweep::stats
