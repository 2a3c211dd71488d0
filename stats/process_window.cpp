#include "stats/process_window.hpp"

#include "stats/confidence.hpp"
#include "stats/sobol_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::size_t integration_points = 1024;

double normal_cdf(double u) {
    return 0.5 * std::erfc(-u / std::numbers::sqrt2);
}

double normal_density(double u) {
    return std::exp(-0.5 * u * u) / std::sqrt(2 * std::numbers::pi);
}

double spread(const Prediction& p, Judged judged) {
    return judged == Judged::mean ? p.mean_error : p.run_error();
}

/// Distribution function of a prediction in its standard errors: Student's, normal where freedom is infinite.
double cdf(double u, double freedom) {
    if (std::isinf(u)) return u > 0 ? 1 : 0;
    return std::isfinite(freedom) ? student_probability(freedom, u) : normal_cdf(u);
}

/// P(low <= y <= high) of a prediction; a certain one is inside or it is not.
double within(const Bounds& bounds, const Prediction& p, Judged judged) {
    const double error = spread(p, judged);
    if (!(error > 0)) return p.mean >= bounds.low && p.mean <= bounds.high ? 1 : 0;
    // Differences of the nearer tail: no cancellation far out.
    const double low = (bounds.low - p.mean) / error, high = (bounds.high - p.mean) / error;
    return low > 0 ? cdf(-low, p.freedom) - cdf(-high, p.freedom) : cdf(high, p.freedom) - cdf(low, p.freedom);
}

std::vector<std::vector<Prediction>> predict_all(std::span<const ModelAt> models) {
    std::vector<std::vector<Prediction>> predictions;
    for (const ModelAt& m : models) {
        if (m.points.size() != models.front().points.size())
            throw std::invalid_argument("process window: models are asked at different numbers of points");
        predictions.push_back(m.model.predict(m.points));
    }
    return predictions;
}

std::vector<double> freedom_of(std::span<const ModelAt> models) {
    std::vector<double> freedom;
    for (const ModelAt& m : models) freedom.push_back(m.model.freedom());
    return freedom;
}

/// m* of the header; none where the condition is nowhere more likely than not.
std::optional<double> effective_best(std::span<const Prediction> objective, std::span<const double> probability,
                                     double sign) {
    std::optional<double> best;
    double best_cautious = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < objective.size(); ++i) {
        const double cautious = sign * objective[i].mean - objective[i].mean_error;
        if (probability[i] < 0.5 || cautious <= best_cautious) continue;
        best_cautious = cautious;
        best = sign * objective[i].mean;
    }
    return best;
}

/// Cases chosen so far as fantasies: each says what was predicted, so that means stay and variances shrink,
/// var(x) <- var(x) - c(x)^2/(var(x*) + scatter(x*)^2), c(x) = cov(x, x*) given the fantasies before.
class Fantasies {
public:
    explicit Fantasies(std::span<const ModelAt> models) : models_(models), effects_(models.size()) {}

    void add(std::vector<std::vector<Prediction>>& predictions, std::size_t chosen) {
        for (std::size_t k = 0; k < models_.size(); ++k) {
            auto& row = predictions[k];
            auto c = models_[k].model.covariances_with(models_[k].points, models_[k].points.row(chosen));
            for (const Effect& before : effects_[k])
                for (std::size_t i = 0; i < c.size(); ++i) c[i] -= before.c[i] * before.c[chosen] / before.variance;
            const double variance = std::pow(row[chosen].run_error(), 2);
            if (!(variance > 0)) continue;  // known already, without any noise
            for (std::size_t i = 0; i < c.size(); ++i)
                row[i].mean_error = std::sqrt(std::max(std::pow(row[i].mean_error, 2) - c[i] * c[i] / variance, 0.0));
            effects_[k].push_back({std::move(c), variance});
        }
    }

private:
    struct Effect {
        std::vector<double> c;
        double variance;
    };
    std::span<const ModelAt> models_;
    std::vector<std::vector<Effect>> effects_;
};

}  // namespace

std::vector<double> probability_within(std::span<const ModelAt> models, std::span<const Bounds> bounds, Judged judged) {
    if (models.empty() || models.size() != bounds.size())
        throw std::invalid_argument("process window: one pair of bounds is needed for each model");
    const auto predictions = predict_all(models);
    std::vector<double> probability(models.front().points.size(), 1);
    for (std::size_t k = 0; k < models.size(); ++k)
        for (std::size_t i = 0; i < probability.size(); ++i)
            probability[i] *= within(bounds[k], predictions[k][i], judged);
    return probability;
}

/// By Sobol points, cells centred.
SampledErrors::SampledErrors(std::span<const double> freedom) : models_(freedom.size()) {
    if (freedom.empty()) throw std::invalid_argument("process window: no model");
    SobolSequence sequence(models_);
    constexpr double cells = 0x1p64;
    for (std::size_t i = 0; i < integration_points * models_; ++i) {
        const double drawn = (static_cast<double>(sequence.next()) + 0.5 * cells / integration_points) / cells;
        const double u = std::min(drawn, 1 - 0x1p-53);
        const double f = freedom[i % models_];
        errors_.push_back(std::isfinite(f) ? student_quantile(f, u) : normal_quantile(u));
    }
}

std::size_t SampledErrors::points() const {
    return integration_points;
}

std::vector<double> probability_of(std::span<const std::vector<Prediction>> predictions, const Condition& condition,
                                   Judged judged, const SampledErrors& errors) {
    const std::size_t d = predictions.size();
    if (d != errors.models()) throw std::invalid_argument("process window: errors of another number of models");
    const std::size_t n = predictions.front().size();
    std::vector<double> probability(n), responses(d);
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t held = 0;
        for (std::size_t q = 0; q < errors.points(); ++q) {
            const auto error = errors.at(q);
            for (std::size_t k = 0; k < d; ++k)
                responses[k] = predictions[k][i].mean + spread(predictions[k][i], judged) * error[k];
            held += condition(responses) ? 1U : 0U;
        }
        probability[i] = static_cast<double>(held) / static_cast<double>(errors.points());
    }
    return probability;
}

std::vector<double> probability_of(std::span<const ModelAt> models, const Condition& condition, Judged judged) {
    return probability_of(predict_all(models), condition, judged, SampledErrors(freedom_of(models)));
}

std::optional<std::size_t> best_setting(std::span<const Prediction> objective, std::span<const double> probability,
                                        bool maximise, double risk) {
    std::optional<std::size_t> best;
    const double sign = maximise ? 1 : -1;
    for (std::size_t i = 0; i < objective.size(); ++i)
        if (probability[i] >= 1 - risk && (!best || sign * objective[i].mean > sign * objective[*best].mean)) best = i;
    return best;
}

std::vector<double> expected_improvement(std::span<const Prediction> objective, std::span<const double> probability,
                                         bool maximise) {
    if (objective.size() != probability.size())
        throw std::invalid_argument("process window: one probability is needed for each setting");
    const double sign = maximise ? 1 : -1;
    const auto best = effective_best(objective, probability, sign);
    std::vector<double> gain(objective.size());
    for (std::size_t i = 0; i < gain.size(); ++i) {
        const Prediction& p = objective[i];
        gain[i] = probability[i];
        if (!best) continue;
        const double above = sign * p.mean - *best, s = p.mean_error;
        const double improvement =
            s > 0 ? above * normal_cdf(above / s) + s * normal_density(above / s) : std::max(above, 0.0);
        const double learned = s > 0 ? 1 - p.scatter / std::hypot(s, p.scatter) : 0;
        gain[i] *= improvement * learned;
    }
    return gain;
}

std::vector<std::size_t> next_cases(std::span<const ModelAt> candidates, const Condition& condition,
                                    std::optional<Objective> objective, Judged judged, std::size_t count) {
    if (candidates.empty() || (!condition && !objective))
        throw std::invalid_argument("process window: next cases need a model and a condition or an objective");
    if (objective && objective->model >= candidates.size())
        throw std::invalid_argument("process window: the objective names a model that is not there");
    auto predictions = predict_all(candidates);
    const SampledErrors errors(freedom_of(candidates));
    Fantasies fantasies(candidates);
    std::vector<std::size_t> chosen;
    while (chosen.size() < std::min(count, predictions.front().size())) {
        std::vector<double> probability(predictions.front().size(), 1);
        if (condition) probability = probability_of(predictions, condition, judged, errors);
        std::vector<double> gain = probability;
        if (objective)
            gain = expected_improvement(predictions[objective->model], probability, objective->maximise);
        else
            for (double& p : gain) p = std::min(p, 1 - p);
        for (const std::size_t i : chosen) gain[i] = 0;
        const auto best = static_cast<std::size_t>(std::ranges::max_element(gain) - gain.begin());
        if (!(gain[best] > 0)) break;
        chosen.push_back(best);
        fantasies.add(predictions, best);
    }
    return chosen;
}

std::vector<std::size_t> trade_off_front(std::span<const double> first, bool maximise_first,
                                         std::span<const double> second, bool maximise_second) {
    if (first.size() != second.size())
        throw std::invalid_argument("process window: the two figures have different numbers of points");
    const double sign = maximise_first ? 1 : -1, other_sign = maximise_second ? 1 : -1;
    std::vector<std::size_t> order(first.size()), front;
    std::iota(order.begin(), order.end(), std::size_t{0});
    // From the best first figure on, a point is on the front where its second figure is better than all before.
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
        if (first[a] != first[b]) return sign * first[a] > sign * first[b];
        if (second[a] != second[b]) return other_sign * second[a] > other_sign * second[b];
        return a < b;
    });
    for (const std::size_t i : order)
        if (std::isfinite(first[i]) && std::isfinite(second[i]) &&
            (front.empty() || other_sign * second[i] > other_sign * second[front.back()]))
            front.push_back(i);
    if (maximise_first) std::ranges::reverse(front);
    return front;
}

}  // namespace grainsweep::stats
