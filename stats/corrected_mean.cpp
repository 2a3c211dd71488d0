#include "stats/corrected_mean.hpp"

#include "stats/confidence.hpp"
#include "stats/least_squares.hpp"
#include "stats/response/fit.hpp"
#include "stats/response/kriging.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace grainsweep::stats {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr std::array predictor_words = {"none", "difference", "slope", "factors", "squares", "model"};

/// Points with a cheap value. `pairs`: rows of the points that have an expensive value, too.
struct Sample {
    std::size_t sequences = 1, dimensions = 0;
    std::vector<std::size_t> sequence;  ///< of each row
    Eigen::VectorXd cheap, expensive;   ///< NaN: no pair
    Eigen::MatrixXd factors;
    std::vector<Eigen::Index> pairs;

    [[nodiscard]] Eigen::Index size() const { return cheap.size(); }
    [[nodiscard]] std::size_t of(Eigen::Index row) const { return sequence[static_cast<std::size_t>(row)]; }
};

Sample sample_of(const PairedValues& values) {
    Sample sample{values.sequences, values.points.dimensions, {}, {}, {}, {}, {}};
    std::vector<std::size_t> rows;
    for (std::size_t p = 0; p < values.cheap.size(); ++p)
        if (std::isfinite(values.cheap[p])) rows.push_back(p);
    const auto n = static_cast<Eigen::Index>(rows.size());
    sample.cheap.resize(n);
    sample.expensive.setConstant(n, not_known);
    sample.factors.resize(n, static_cast<Eigen::Index>(sample.dimensions));
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto p = rows[static_cast<std::size_t>(i)];
        sample.sequence.push_back(p % values.sequences);
        sample.cheap(i) = values.cheap[p];
        for (std::size_t j = 0; j < sample.dimensions; ++j)
            sample.factors(i, static_cast<Eigen::Index>(j)) = values.points.row(p)[j];
        if (p >= values.expensive.size() || !std::isfinite(values.expensive[p])) continue;
        sample.expensive(i) = values.expensive[p];
        sample.pairs.push_back(i);
    }
    return sample;
}

/// Values of g at every row, fitted without the sequence of the row.
struct PairPrediction {
    PairPredictor by = PairPredictor::none;
    Eigen::VectorXd g;
    Eigen::Index coefficients = 0;
};

/// Returns the first `count` columns of: 1, the cheap value, the factors, their squares.
Eigen::MatrixXd terms_of(const Sample& sample, Eigen::Index count) {
    Eigen::MatrixXd terms(sample.size(), 2 + 2 * sample.factors.cols());
    terms << Eigen::VectorXd::Ones(sample.size()), sample.cheap, sample.factors, sample.factors.cwiseAbs2();
    return terms.leftCols(count);
}

PairPrediction regression(const Sample& sample, PairPredictor by, Eigen::Index count) {
    PairPrediction found{by, Eigen::VectorXd::Constant(sample.size(), not_known), count};
    const auto terms = terms_of(sample, count);
    for (std::size_t s = 0; s < sample.sequences; ++s) {
        std::vector<Eigen::Index> teachers;
        for (const auto row : sample.pairs)
            if (sample.of(row) != s) teachers.push_back(row);
        const Eigen::VectorXd b = least_squares(terms(teachers, Eigen::all), sample.expensive(teachers));
        for (Eigen::Index i = 0; i < sample.size(); ++i)
            if (sample.of(i) == s) found.g(i) = terms.row(i) * b;
    }
    return found;
}

/// Predicts the sequences of one parity by a model whose hyperparameters are fitted to the other sequences. Returns
/// false if no model can be fitted.
bool add_model(const Sample& sample, const Eigen::VectorXd& z, std::size_t parity, Eigen::VectorXd& model_of_z) {
    constexpr std::size_t starts = 2, most = 200;
    std::vector<Eigen::Index> teachers;
    std::vector<std::vector<Eigen::Index>> left_out((sample.sequences + 1 - parity) / 2);
    for (Eigen::Index k = 0; k < std::ssize(sample.pairs); ++k) {
        const auto s = sample.of(sample.pairs[static_cast<std::size_t>(k)]);
        if (s % 2 == parity)
            left_out[s / 2].push_back(k);
        else
            teachers.push_back(k);
    }
    const Eigen::MatrixXd x = sample.factors(sample.pairs, Eigen::all);
    const auto h =
        response::find_hyperparameters(x(teachers, Eigen::all), z(teachers), {starts, most, LearnedMap::never});
    const auto model = h ? response::solve_kriging(*h, x, z) : std::nullopt;
    if (!model) return false;
    const auto weights = response::leave_folds_out(*model, response::inverse_of(*model), left_out);
    const Eigen::MatrixXd means = weights.predict(*model, response::mapped(*h, sample.factors));
    for (Eigen::Index i = 0; i < sample.size(); ++i)
        if (sample.of(i) % 2 == parity) model_of_z(i) = means(i, static_cast<Eigen::Index>(sample.of(i) / 2));
    return true;
}

std::optional<PairPrediction> model_of_difference(const Sample& sample) {
    const Eigen::VectorXd d = sample.expensive(sample.pairs) - sample.cheap(sample.pairs);
    const double mean = d.mean(), sd = std::sqrt((d.array() - mean).square().mean());
    if (!(sd > 0)) return std::nullopt;
    PairPrediction found{PairPredictor::model, Eigen::VectorXd::Zero(sample.size()), 1};
    const Eigen::VectorXd z = (d.array() - mean) / sd;
    for (const std::size_t parity : {std::size_t{0}, std::size_t{1}})
        if (!add_model(sample, z, parity, found.g)) return std::nullopt;
    found.g = sample.cheap.array() + mean + sd * found.g.array();
    return found;
}

/// Returns t sd/sqrt(n) of the residuals from a trend with `coefficients` coefficients.
double corrected_half_width(const Eigen::VectorXd& residuals, Eigen::Index coefficients) {
    const auto n = static_cast<double>(residuals.size());
    const double freedom = n - static_cast<double>(std::max<Eigen::Index>(coefficients, 1));
    if (freedom < 1) return not_known;
    const double squares = (residuals.array() - residuals.mean()).square().sum();
    return student_factor(static_cast<std::int64_t>(freedom)) * std::sqrt(squares / (n - 1) / n);
}

Eigen::VectorXd residuals_of(const Sample& sample, const PairPrediction& prediction) {
    return sample.expensive(sample.pairs) - prediction.g(sample.pairs);
}

std::vector<PairPrediction> predictions_of(const Sample& sample) {
    constexpr Eigen::Index pairs_each = 4, model_from = 24, model_to = 500;
    const auto pairs = std::ssize(sample.pairs);
    const auto width = static_cast<Eigen::Index>(sample.dimensions);
    std::vector<PairPrediction> all = {{PairPredictor::difference, sample.cheap, 1}};
    if (pairs >= pairs_each * 2) all.push_back(regression(sample, PairPredictor::slope, 2));
    if (width == 0) return all;
    if (pairs >= pairs_each * (2 + width)) all.push_back(regression(sample, PairPredictor::factors, 2 + width));
    if (pairs >= pairs_each * (2 + 2 * width)) all.push_back(regression(sample, PairPredictor::squares, 2 + 2 * width));
    if (pairs >= model_from && pairs <= model_to)
        if (auto model = model_of_difference(sample)) all.push_back(*std::move(model));
    return all;
}

PairPrediction best_prediction(const Sample& sample) {
    auto all = predictions_of(sample);
    return *std::ranges::min_element(all, {}, [&](const PairPrediction& one) {
        const double half_width = corrected_half_width(residuals_of(sample, one), one.coefficients);
        return std::isnan(half_width) ? std::numeric_limits<double>::infinity() : half_width;
    });
}

/// Returns the mean of `of` in each sequence, from the given rows.
std::vector<double> corrected_by_sequence(const Sample& sample, std::span<const Eigen::Index> rows,
                                          const Eigen::VectorXd& of) {
    std::vector<double> sums(sample.sequences, 0), counts(sample.sequences, 0);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        sums[sample.of(rows[k])] += of(static_cast<Eigen::Index>(k));
        ++counts[sample.of(rows[k])];
    }
    for (std::size_t s = 0; s < sums.size(); ++s) sums[s] /= counts[s];
    return sums;
}

/// Returns Student's half-width; undefined if all repetitions are equal, because their scatter is then unknown.
double over_sequences(std::span<const double> repetitions) {
    const double half_width = student_half_width(repetitions);
    return half_width > 0 ? half_width : not_known;
}

/// Combines two estimates of a half-width: the larger one if there are few pairs, else the root mean square (as in
/// stats/assisted_moments.hpp).
double both(double a, double b, std::ptrdiff_t pairs) {
    constexpr std::ptrdiff_t fewest_averaged = 200;
    if (std::isnan(a) || std::isnan(b)) return not_known;
    return pairs < fewest_averaged ? std::max(a, b) : std::hypot(a, b) / std::sqrt(2.0);
}

/// Returns the half-width of the mean of g from the residuals of a linear trend over the factors.
double corrected_scatter(const Sample& sample, const Eigen::VectorXd& g) {
    const auto width = static_cast<Eigen::Index>(sample.dimensions);
    Eigen::MatrixXd terms = Eigen::MatrixXd::Ones(sample.size(), 1 + width);
    terms.rightCols(width) = sample.factors;
    if (sample.size() < 2 * terms.cols()) return corrected_half_width(g, 1);
    const Eigen::VectorXd residuals = g - terms * least_squares(terms, g);
    const auto n = static_cast<double>(sample.size()), freedom = n - static_cast<double>(terms.cols());
    return corrected_half_width(residuals, terms.cols()) * std::sqrt((n - 1) / freedom);
}

}  // namespace

std::string_view to_string(PairPredictor predictor) {
    return predictor_words.at(static_cast<std::size_t>(predictor));
}

CorrectedMean corrected_mean(const PairedValues& values) {
    CorrectedMean found;
    const auto sample = sample_of(values);
    const bool paired = !values.expensive.empty();
    if (sample.size() == 0 || (paired && sample.pairs.empty())) return found;
    const auto prediction = paired ? best_prediction(sample) : PairPrediction{PairPredictor::none, sample.cheap, 0};
    std::vector<Eigen::Index> all(static_cast<std::size_t>(sample.size()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Eigen::Index>(i);
    const auto s = corrected_by_sequence(sample, all, prediction.g);
    found.by = prediction.by;
    found.value = prediction.g.mean();
    found.statistics = over_sequences(s);
    found.scatter = corrected_scatter(sample, prediction.g);
    found.numerics = 0;
    found.together = found.statistics;
    if (!paired) return found;

    const auto residuals = residuals_of(sample, prediction);
    const auto d = corrected_by_sequence(sample, sample.pairs, residuals);
    std::vector<double> t;
    for (std::size_t k = 0; k < s.size(); ++k) t.push_back(s[k] + d[k]);
    const bool equal = sample.expensive(sample.pairs) == sample.cheap(sample.pairs);
    const double by_cases = corrected_half_width(residuals, prediction.coefficients);
    found.value += residuals.mean();
    found.numerics = equal ? not_known : both(student_half_width(d), by_cases, std::ssize(sample.pairs));
    const double parts = std::hypot(found.statistics, found.numerics), whole = over_sequences(t);
    found.together = whole > parts ? std::hypot(parts, whole) / std::sqrt(2.0) : parts;
    return found;
}

}  // namespace grainsweep::stats
