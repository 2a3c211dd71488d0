#include "stats/levels.hpp"

#include "stats/confidence.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace grainsweep::stats {
namespace {

constexpr std::size_t groups_of_batches = 8, fewest_in_group = 4, fewest_beyond = 10;
constexpr double tail_of_interval = 0.025;

/// How far a share may lie below and above its estimate.
struct Arms {
    double below = 0, above = 0;
};

using Binomial = boost::math::binomial_distribution<double>;

double share_below(std::span<const double> values, double threshold) {
    return static_cast<double>(std::ranges::count_if(values, [&](double y) { return y < threshold; })) /
           static_cast<double>(values.size());
}

/// Student half-width over the shares of the groups' beginnings.
double half_width_at(std::span<const std::span<const double>> groups, std::size_t halvings, const auto& share) {
    std::vector<double> shares;
    for (std::size_t g = 0; g < groups.size(); ++g) shares.push_back(share(g, groups[g].size() >> halvings));
    return student_half_width(shares);
}

std::size_t shortest(std::span<const std::span<const double>> groups) {
    return groups.empty() ? 0 : std::ranges::min(groups, {}, [](const auto& g) { return g.size(); }).size();
}

/// e of the header but for few values; `share`: of the first n values of a group.
double share_error(const GroupedSample& sample, const auto& share) {
    const std::size_t least = shortest(sample.groups);
    if (least < fewest_in_group) return std::numeric_limits<double>::quiet_NaN();
    double error = half_width_at(sample.groups, 0, share), fall = 1;
    for (std::size_t k = 1; sample.independent && k <= most_halvings && (least >> k) >= fewest_in_group; ++k) {
        fall *= steepest_fall;
        error = std::max(error, fall * half_width_at(sample.groups, k, share));
    }
    const double rounded = static_cast<double>(least) * std::sqrt(12 * static_cast<double>(sample.groups.size()));
    return std::max(error, normal_95 / rounded);
}

double share_error_at(const GroupedSample& sample, double threshold) {
    const double error = share_error(
        sample, [&](std::size_t g, std::size_t n) { return share_below(sample.groups[g].first(n), threshold); });
    const double p = share_below(sample.sorted, threshold);
    return std::hypot(error, normal_95 * sample.repeated * std::sqrt(p * (1 - p)));
}

/// Arms of a share of which `count` of `all` values were seen, with error e.
Arms arms_of_share(std::size_t count, std::size_t all, double error) {
    Arms arms{error, error};
    if (std::min(count, all - count) >= fewest_beyond) return arms;
    const auto n = static_cast<double>(all), k = static_cast<double>(count);
    arms.below = std::max(error, k / n - Binomial::find_lower_bound_on_p(n, k, tail_of_interval));
    arms.above = std::max(error, Binomial::find_upper_bound_on_p(n, k, tail_of_interval) - k / n);
    return arms;
}

/// Arms of the probability of a quantile: of the order statistics that enclose it.
Arms arms_of_probability(double q, std::size_t all, double error) {
    Arms arms{error, error};
    const auto n = static_cast<double>(all);
    if (n * std::min(q, 1 - q) >= fewest_beyond) return arms;
    const Binomial below(n, q);
    arms.below = std::max(error, q - boost::math::quantile(below, tail_of_interval) / n);
    arms.above = std::max(error, boost::math::quantile(boost::math::complement(below, tail_of_interval)) / n - q);
    return arms;
}

/// none: outside of the sample.
std::optional<double> quantile_of(std::span<const double> sorted, double q) {
    return q > 0 && q < 1 ? std::optional(quantile_of_sorted(sorted, q)) : std::nullopt;
}

LevelEstimate level_estimate(const Quantile& wanted, const GroupedSample& sample) {
    const double q = wanted.probability;
    LevelEstimate found{wanted, *quantile_of(sample.sorted, q)};
    const Arms arms = arms_of_probability(q, sample.sorted.size(), share_error_at(sample, found.value));
    const auto low = quantile_of(sample.sorted, q - arms.below), high = quantile_of(sample.sorted, q + arms.above);
    if (low && high) found.error = std::max(found.value - *low, *high - found.value);
    return found;
}

LevelEstimate level_estimate(const Exceedance& wanted, const GroupedSample& sample) {
    const auto above = static_cast<std::size_t>(std::ranges::end(sample.sorted) -
                                                std::ranges::upper_bound(sample.sorted, wanted.threshold));
    const auto below = static_cast<std::size_t>(std::ranges::lower_bound(sample.sorted, wanted.threshold) -
                                                std::ranges::begin(sample.sorted));
    const std::size_t count = wanted.above ? above : below, all = sample.sorted.size();
    // P(y > t) differs between groups as P(y < next value) does.
    const double past = std::nextafter(wanted.threshold, std::numeric_limits<double>::infinity());
    const Arms arms = arms_of_share(count, all, share_error_at(sample, wanted.above ? past : wanted.threshold));
    return {wanted, static_cast<double>(count) / static_cast<double>(all), std::max(arms.below, arms.above)};
}

/// Distribution function with the model, and its error, at one threshold.
class ModelDistribution {
public:
    explicit ModelDistribution(const LeftOutPredictions& model)
        : model_(model), sizes_(model.spread.size(), 0), spread_(model.spread) {
        for (auto& all : spread_)
            for (std::size_t k = 0; k < model.scramblings; ++k) std::ranges::sort(part_of(std::span(all), k));
        for (const std::size_t s : model.sequences) ++sizes_[s];
        double squares = 0;
        for (std::size_t i = 0; i < model.values.size(); ++i)
            squares += std::pow(model.values[i] - model.predicted[i], 2);
        error_ = std::sqrt(squares / static_cast<double>(model.values.size()));
        double noise = 0;
        for (const double sd : model.noise) noise += sd * sd / static_cast<double>(model.noise.size());
        misfit_ = std::sqrt(std::max(error_ * error_ - noise, 0.0));
    }

    [[nodiscard]] double at(double threshold) const {
        const auto each = by_sequence(threshold);
        return std::accumulate(each.begin(), each.end(), 0.0) / static_cast<double>(each.size());
    }

    /// (a) to (d) of the header.
    [[nodiscard]] double error_at(double threshold) const {
        double squares = 0, sum = 0, expected = 0;
        for (std::size_t i = 0; i < model_.values.size(); ++i) {
            const double r = residual(i, threshold);
            squares += r * r;
            sum += r;
            const double p = below(model_.predicted[i], error_, threshold);
            expected += p * (1 - p);
        }
        const auto n = static_cast<double>(model_.values.size());
        const double variance = (squares - sum * sum / n) / (n * (n - 1));
        const double error =
            std::max({student_half_width(by_sequence(threshold)), normal_95 * std::sqrt(std::max(variance, 0.0)),
                      normal_95 * std::sqrt(expected) / n, (at(threshold + misfit_) - at(threshold - misfit_)) / 2});
        std::vector<double> integrals(model_.scramblings, 0);
        for (std::size_t s = 0; s < sizes_.size(); ++s)
            for (std::size_t k = 0; k < model_.scramblings; ++k)
                integrals[k] += integral(s, k, threshold) / static_cast<double>(sizes_.size());
        // Each scrambling counts whole points, and in one dimension all count alike.
        const double rounding =
            static_cast<double>(model_.scramblings) / static_cast<double>(model_.spread.front().size());
        const double by_points = model_.scramblings > 1 ? student_half_width(integrals) : 0;
        return std::hypot(error, std::max(by_points, rounding));
    }

private:
    static double below(double mean, double noise, double threshold) {
        if (noise > 0) return normal_cdf((threshold - mean) / noise);
        return mean < threshold ? 1 : 0;
    }
    [[nodiscard]] double residual(std::size_t i, double threshold) const {
        return (model_.values[i] < threshold ? 1 : 0) -
               below(model_.predicted[i], model_.noise[model_.sequences[i]], threshold);
    }
    template <class T>
    [[nodiscard]] std::span<T> part_of(std::span<T> all, std::size_t scrambling) const {
        const std::size_t size = all.size() / model_.scramblings;
        return all.subspan(scrambling * size, size);
    }
    /// Mean over one scrambling of the integration points. Beyond 8.3 standard deviations a normal probability is 0 or
    /// 1 to rounding.
    [[nodiscard]] double integral(std::size_t sequence, std::size_t scrambling, double threshold) const {
        const std::span<const double> ascending = part_of(std::span(spread_[sequence]), scrambling);
        const double noise = model_.noise[sequence], reach = 8.3 * noise;
        const auto near = std::ranges::lower_bound(ascending, threshold - reach);
        const auto far = std::ranges::upper_bound(near, ascending.end(), threshold + reach);
        auto sum = static_cast<double>(near - ascending.begin());
        for (auto m = near; m != far; ++m) sum += below(*m, noise, threshold);
        return sum / static_cast<double>(ascending.size());
    }
    [[nodiscard]] std::vector<double> by_sequence(double threshold) const {
        std::vector<double> each(sizes_.size(), 0);
        for (std::size_t s = 0; s < each.size(); ++s)
            for (std::size_t k = 0; k < model_.scramblings; ++k)
                each[s] += integral(s, k, threshold) / static_cast<double>(model_.scramblings);
        for (std::size_t i = 0; i < model_.values.size(); ++i)
            each[model_.sequences[i]] += residual(i, threshold) / sizes_[model_.sequences[i]];
        return each;
    }

    const LeftOutPredictions& model_;
    std::vector<double> sizes_;
    std::vector<std::vector<double>> spread_;  ///< of the model, each scrambling ascending
    double error_ = 0;                         ///< rms on left-out sequences
    double misfit_ = 0;                        ///< the part of it that is no noise
};

/// The threshold of a probability; none: it lies outside of the values.
std::optional<double> threshold_of(const ModelDistribution& model, double q, double low, double high) {
    constexpr int bits = 24;
    if (!(q > 0 && q < 1)) return std::nullopt;
    const auto beyond = [&](double threshold) { return model.at(threshold) - q; };
    const double at_low = beyond(low), at_high = beyond(high);
    if (!(at_low < 0)) return low;
    if (!(at_high > 0)) return high;
    std::uintmax_t evaluations = 60;
    const auto [from, to] = boost::math::tools::toms748_solve(
        beyond, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(bits), evaluations);
    return std::midpoint(from, to);
}

}  // namespace

std::string to_string(const Level& level) {
    const auto text = [](std::string kind, double x) {
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.begin(), digits.end(), x).ptr;
        return kind.append(digits.data(), end);
    };
    if (const auto* quantile = std::get_if<Quantile>(&level)) return text("quantile:", quantile->probability);
    const auto& beyond = std::get<Exceedance>(level);
    return text(beyond.above ? "above:" : "below:", beyond.threshold);
}

std::optional<Level> level_named(std::string_view word) {
    const auto colon = word.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const auto kind = word.substr(0, colon), text = word.substr(colon + 1);
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(x)) return std::nullopt;
    if (kind == "quantile" && x > 0 && x < 1) return Quantile{x};
    if (kind == "above" || kind == "below") return Exceedance{x, kind == "above"};
    return std::nullopt;
}

double quantile_of_sorted(std::span<const double> sorted, double q) {
    const double at = static_cast<double>(sorted.size() - 1) * q;
    const auto low = std::min(static_cast<std::size_t>(at), sorted.size() - 1);
    return std::lerp(sorted[low], sorted[std::min(low + 1, sorted.size() - 1)], at - static_cast<double>(low));
}

std::vector<std::span<const double>> batches_of(std::span<const double> values) {
    std::vector<std::span<const double>> groups;
    const std::size_t n = values.size();
    for (std::size_t g = 0; g < groups_of_batches; ++g) {
        const std::size_t from = n * g / groups_of_batches, to = n * (g + 1) / groups_of_batches;
        groups.push_back(values.subspan(from, to - from));
    }
    return groups;
}

LevelEstimate level_of(const Level& level, const GroupedSample& sample) {
    if (sample.sorted.empty()) return {level};
    return std::visit([&](const auto& wanted) { return level_estimate(wanted, sample); }, level);
}

LevelEstimate assisted_level_of(const Level& level, const LeftOutPredictions& model) {
    LevelEstimate found{level};
    const ModelDistribution distribution(model);
    const auto [lowest, highest] = std::ranges::minmax(model.values);
    const auto n = static_cast<double>(model.values.size());
    const auto enough = [&](double share) { return n * std::min(share, 1 - share) >= fewest_beyond; };
    if (const auto* beyond = std::get_if<Exceedance>(&level)) {
        const double t = beyond->above ? std::nextafter(beyond->threshold, highest + 1) : beyond->threshold;
        if (!enough(share_below(model.values, t))) return found;
        const double share = std::clamp(distribution.at(t), 0.0, 1.0);
        found.value = beyond->above ? 1 - share : share;
        found.error = distribution.error_at(t);
        return found;
    }
    const double q = std::get<Quantile>(level).probability;
    if (!enough(q)) return found;
    found.value = *threshold_of(distribution, q, lowest, highest);
    const double error = distribution.error_at(found.value);
    const auto low = threshold_of(distribution, q - error, lowest, highest);
    const auto high = threshold_of(distribution, q + error, lowest, highest);
    if (low && high) found.error = std::max(found.value - *low, *high - found.value);
    return found;
}

}  // namespace grainsweep::stats
