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

constexpr std::size_t scramblings = 8, points_each = 1024, base_points = scramblings * points_each, batches = 8;

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
            const std::size_t group = groups.empty() ? i * batches / used.size() : groups[used[i]];
            left_out.resize(std::max(left_out.size(), group + 2));
            left_out[group + 1].push_back(static_cast<Eigen::Index>(i));
        }
        folds_ = response::leave_folds_out(state_.kriging, response::inverse_of(state_.kriging), left_out);
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

/// Values that every index needs.
struct Whole {
    Part variance;
    double unseen;  ///< share of the variance of the mean response that is not in the model

    /// Returns the value of the whole model. The half-width comes from models without a group, from the scramblings,
    /// and from the part of the response that the model misses.
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
    const Part all = means_of(each);
    ModelIndices::Noise found{whole.index_of(all), {}};
    constexpr std::size_t eighths = 8;
    for (const auto j : controls) {
        const auto levels = j < roles.levels.size() ? roles.levels[j] : 0;
        const auto parts = static_cast<double>(levels > 0 ? levels : eighths);
        ModelIndices::Calmest least{j, 0, 1, found.total, {0, 0}};
        for (double part = 0; part < parts; ++part) {
            const double from = part / parts, to = (part + 1) / parts;
            const Part within = means_within(each, base, j, from, to);
            const auto left = whole.index_of(within);
            if (left.value < least.left.value) least = {j, from, to, left, whole.index_of(all - within)};
        }
        found.controls.push_back(least);
    }
    std::ranges::stable_sort(found.controls, {}, [](const auto& one) { return one.left.value; });
    return found;
}

/// Rows of a sample that are nearest to a row in some of its columns.
class NearRows {
public:
    NearRows(const JointSample& sample, std::vector<std::size_t> columns) : sample_(sample) {
        for (const auto c : columns) {
            const auto values = sample.column(c);
            const Eigen::Map<const Eigen::ArrayXd> x(values.data(), static_cast<Eigen::Index>(values.size()));
            const double sd = std::sqrt((x - x.mean()).square().mean());
            scaled_.emplace_back(sd > 0 ? Eigen::ArrayXd((x - x.mean()) / sd) : Eigen::ArrayXd::Zero(x.size()));
        }
        near_.resize(sample.rows());
    }
    /// One of the nearest rows, by 64 random bits; the row itself if it is the only one.
    [[nodiscard]] std::size_t one_near(std::size_t row, std::uint64_t bits) {
        auto& near = near_[row];
        if (near.empty()) near = nearest(row);
        return near[bits % near.size()];
    }

private:
    static constexpr std::size_t neighbours = 4;

    [[nodiscard]] std::vector<std::size_t> nearest(std::size_t row) const {
        Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(sample_.rows()));
        for (const auto& x : scaled_) squares += (x - x(static_cast<Eigen::Index>(row))).square();
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < sample_.rows(); ++i)
            if (i != row) order.push_back(i);
        if (order.empty()) return {row};
        const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(neighbours, order.size()));
        std::ranges::partial_sort(order, end, {}, [&](std::size_t i) { return squares(static_cast<Eigen::Index>(i)); });
        order.erase(end, order.end());
        return order;
    }

    const JointSample& sample_;
    std::vector<Eigen::ArrayXd> scaled_;
    std::vector<std::vector<std::size_t>> near_;
};

/// Factors of one sample, by their columns.
struct Block {
    const JointSample* sample;
    std::vector<std::size_t> factors;
};

std::vector<Block> blocks_of(const FactorRoles& roles) {
    std::vector<Block> blocks;
    for (std::size_t j = 0; j < roles.together.size(); ++j) {
        if (!roles.together[j]) continue;
        const auto* sample = roles.together[j]->sample.get();
        auto found = std::ranges::find(blocks, sample, &Block::sample);
        if (found == blocks.end()) {
            blocks.push_back({sample, std::vector<std::size_t>(sample->columns(), roles.together.size())});
            found = blocks.end() - 1;
        }
        found->factors[roles.together[j]->column] = j;
    }
    // A sample of which a column is no factor gives independent factors.
    std::erase_if(blocks, [&](const Block& block) {
        return block.factors.size() < 2 ||
               std::ranges::find(block.factors, roles.together.size()) != block.factors.end();
    });
    return blocks;
}

/// A^u of the header: points of A with the factors of the mask u, the others given these.
std::vector<double> given(const Base& base, const std::vector<Block>& blocks, std::uint64_t seed, std::size_t mask) {
    const auto d = base.dimensions;
    const auto keeps = [&](std::size_t j) { return (mask >> j & 1U) != 0; };
    auto points = base.b;
    for (std::size_t i = 0; i < base_points; ++i)
        for (std::size_t j = 0; j < d; ++j)
            if (keeps(j)) points[i * d + j] = base.a[i * d + j];
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const auto& block = blocks[k];
        std::vector<std::size_t> columns;
        for (std::size_t c = 0; c < block.factors.size(); ++c)
            if (keeps(block.factors[c])) columns.push_back(c);
        if (columns.empty() || columns.size() == block.factors.size()) continue;
        NearRows rows(*block.sample, columns);
        std::vector<double> place(block.factors.size()), values(place.size());
        for (std::size_t i = 0; i < base_points; ++i) {
            for (std::size_t c = 0; c < place.size(); ++c) place[c] = base.a[i * d + block.factors[c]];
            const auto row = rows.one_near(block.sample->row_at(place), bits_at(seed, mask * blocks.size() + k, i));
            for (std::size_t c = 0; c < values.size(); ++c) values[c] = block.sample->column(c)[row];
            const auto there = block.sample->place_of(values).value();
            for (std::size_t c = 0; c < there.size(); ++c) points[i * d + block.factors[c]] = there[c];
        }
    }
    return points;
}

/// Sums of one quantity over parts of the rows of the first sample: its half-width with respect to the rows.
class RowParts {
public:
    RowParts(const Base& base, const Block& block) : part_(base_points) {
        std::vector<double> place(block.factors.size());
        for (std::size_t i = 0; i < base_points; ++i) {
            for (std::size_t c = 0; c < place.size(); ++c) place[c] = base.a[i * base.dimensions + block.factors[c]];
            part_[i] = splitmix64(block.sample->row_at(place)) % batches;
            count_(static_cast<Eigen::Index>(part_[i])) += 1;
        }
    }
    /// Means of the values without the points of each part.
    [[nodiscard]] Eigen::ArrayXd without_each(const Eigen::ArrayXd& values) const {
        Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(batches);
        for (std::size_t i = 0; i < base_points; ++i)
            sums(static_cast<Eigen::Index>(part_[i])) += values(static_cast<Eigen::Index>(i));
        return (sums.sum() - sums) / (static_cast<double>(base_points) - count_);
    }

private:
    std::vector<std::size_t> part_;
    Eigen::ArrayXd count_ = Eigen::ArrayXd::Zero(batches);
};

std::vector<SensitivityIndex> shapley_effects(const Versions& versions, const Base& base, const Whole& whole,
                                              const Eigen::MatrixXd& a, const Eigen::RowVectorXd& centre,
                                              const FactorRoles& roles, std::uint64_t seed) {
    const auto blocks = blocks_of(roles);
    const std::size_t d = base.dimensions;
    if (blocks.empty() || d > most_shared_factors) return {};
    const std::size_t all = (std::size_t{1} << d) - 1;
    const RowParts rows(base, blocks.front());
    const Eigen::ArrayXXd about = (a.rowwise() - centre).array();
    std::vector<Part> explained;               // W of every subset
    std::vector<Eigen::ArrayXd> in_row_parts;  // the same without each part of the rows
    for (std::size_t mask = 0; mask <= all; ++mask) {
        Eigen::ArrayXXd each = Eigen::ArrayXXd::Zero(about.rows(), about.cols());
        if (mask == all) each = about.square();
        if (mask != 0 && mask != all)
            each = about * (versions.at(given(base, blocks, seed, mask), d).rowwise() - centre).array();
        explained.push_back(mask == all ? whole.variance : means_of(each));
        in_row_parts.push_back(rows.without_each(each.col(0)));
    }
    std::vector<SensitivityIndex> effects;
    for (std::size_t j = 0; j < d; ++j) {
        Part part = Part::Zero(whole.variance.rows(), whole.variance.cols());
        Eigen::ArrayXd without = Eigen::ArrayXd::Zero(batches);
        for (std::size_t mask = 0; mask <= all; ++mask) {
            if ((mask >> j & 1U) != 0) continue;
            const auto size = static_cast<double>(std::popcount(mask)), n = static_cast<double>(d);
            const double weight = std::tgamma(size + 1) * std::tgamma(n - size) / std::tgamma(n + 1);
            const auto with = mask | std::size_t{1} << j;
            part += weight * (explained[with] - explained[mask]);
            without += weight * (in_row_parts[with] - in_row_parts[mask]);
        }
        without /= in_row_parts[all];
        auto& effect = effects.emplace_back(whole.index_of(part));
        effect.half_width = std::hypot(effect.half_width, jackknife_half_width({without.data(), batches}));
    }
    return effects;
}

}  // namespace

ModelIndices model_indices(const ResponseModel& model, std::size_t factors, std::span<const std::size_t> groups,
                           const FeatureMap& features, const FactorRoles& roles) {
    if (factors == 0 || (!features && factors != model.dimensions()))
        throw std::invalid_argument("indices of a model: factors and features are of different numbers");
    const Versions versions(model, groups, features);
    const auto seed = seed_of(model.state().kriging.values);
    const Base base = base_of(factors, seed);
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
    result.shapley = shapley_effects(versions, base, whole, a, centre, roles, seed);
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
