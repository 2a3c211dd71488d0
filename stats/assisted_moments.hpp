// Moments of a response with a model of it as control variate: the same answer from a fraction of the cases.
//
// S >= 4 independently randomised sequences are the folds. With standardised responses z, m_s the response model
// without sequence s, v its noise variance and the closure g_p = E[z^p | m, v] = m, m^2 + v, m^3 + 3 m v, m^4 + 6 m^2 v
// + 3 v^2:
//
//   M_p = mean over s of M_p^(s),   M_p^(s) = mean over Q of g_p(m_s(x_q)) + mean over i in s of (z_i^p -
//   g_p(m_s(x_i))) mean, sd, g1, kurtosis = T(M_1 ... M_4)
//
// (cross-fitting as in Chernozhukov et al. 2018, Econometrics J. 21, C1; regression estimation: Saerndal, Swensson &
// Wretman 1992, chapter 6). A sequence never decides the model that corrects it. Hyperparameters for the odd sequences
// are fitted on at most 300 cases of the even ones, and the other way round. Weights without the sequence follow in
// closed form (response/kriging.hpp). A bad model costs accuracy, not truth. v is one value for each half, so that
// it rests on no case of the sequence either; where it is at the bound of the fit (1e-8) it counts as 0 and g_p = m^p.
//
// 95 % half-width of a statistic, from (a) Student t over the S values of grad T . M^(s), (b) t with n_eff - 1 degrees
// of freedom (2 at least) times sqrt(sum r_i^2/(n (n - 1))), r_i = grad T . (z_i^p - g_p)_p, n_eff = (sum r^2)^2/sum
// r^4, and (c) 1.96 times the standard error that normal residuals of the models' size give, sqrt(sum_i Var[sum_p (grad
// T)_p (m_i + s e)^p])/n with s the rms of z_i - m_s(x_i): what decides g1 and kurtosis are tails that few cases may
// not show, and by (a) and (b) alone those samples understate their error (90 % of 95 % half-widths reached the
// kurtosis of 104 normal values). Below 200 cases, and where the models err by half an sd or more, the largest of the
// three. Otherwise (a) and the larger of (b) and (c) are two estimates of one variance, each with its factor for 95 %.
// The root of the mean of their squares is taken: it reached the truth in 96.4 % of campaigns of 400 cases, the larger
// one in 97.4 %. In quadrature the error of Q from its independent scramblings (Student t over their means).
//
// Cases say nothing beyond the outermost of them. Two terms in quadrature (response/beyond_cases.hpp): (d) for each end
// of each feature the 4 outermost cases, predicted from all others: |grad T . sum (z^p - g_p)/n|, less what noise gives
// it; (e) where a tail of the responses has no visible end (tail.hpp), a share of the error that the tail gives the
// plain estimate: three times the part of their distance from the mean by which the model misses the outermost cases,
// and 0.3 at least if Q reaches far beyond the cases (features without an end, such as a normal factor). Above a part
// of 0.1 the model is not taken; where the tail surely has no end, above 0.03, and never for g1 and kurtosis. Of a
// response like exp(normal) or a waiting time, which its cases seem to give exactly, intervals without (e) held in 0 to
// 0.8.
//
// Two targets. With scatter: moments of single runs, what the plain estimate says. Without: of the mean response. By
// the law of total cumulance, with noise of variance v_i that is symmetric about the mean,
//   M - (0, E v, 3 E[m v], 6 E[m^2 v] + 3 E[v^2]),
// (E m and E m^2 from M, covariances of v with m and m^2 over the cases). v_i is the square of the standard error a
// scene states, or one value from replicates.
//
// The estimate of a statistic is chosen beforehand: assisted where the model errs by less than 0.6 sd on left-out
// sequences and the assisted half-width was below the plain one at the previous check. Taking the shorter one each time
// would cost 3 to 10 % of coverage. Where both differ by more than twice their joint half-width the
// plain estimate is taken, with a sentence. If every case has a value, the model has gone wrong: it is withdrawn.
//
// Cases without a value make two populations. The plain estimate describes the cases with a value. The assisted one
// integrates over the whole box, extrapolated into the settings that failed. Both may be right and differ, so neither
// is withdrawn; the plain one is taken because convergence is judged on the cases with a value.
#pragma once

#include "stats/levels.hpp"
#include "stats/moments.hpp"
#include "stats/response_model.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::stats {

/// The statistics there are, in the order of every array here. (Pearson's skewness has no such form: a median.)
inline constexpr std::array assisted_statistics = {Statistic::mean, Statistic::sd, Statistic::g1, Statistic::kurtosis};

struct AssistedSettings {
    std::vector<double> low = {};      ///< box of the features; empty: 0
    std::vector<double> high = {};     ///< empty: 1
    std::size_t cases_in_fit = 300;    ///< of each half, for the hyperparameters
    std::size_t most_training = 1500;  ///< cases the models rest on; all are used for the correction
    std::size_t starts = 4;
    std::span<const Level> levels = {};  ///< of which estimates with the model are wanted
    double refused_error = 0.6;          ///< of the model on left-out sequences, in sd: not assisted from there on
};

struct AssistedInput {
    Rows points;                             ///< features of the cases
    std::span<const double> values;          ///< responses; what is not finite is left out
    std::span<const std::size_t> sequences;  ///< of each case, 0 ... S - 1
    /// Features of points that fill the factors' ranges as the design does (evenly in the factors, not in features such
    /// as their logarithms): independent scramblings of one size, one after the other.
    Rows integration;
    std::size_t scramblings = 1;  ///< at least 4 give integration an error of its own
    /// Variance of a single run about its mean: one per case, one for all, or empty: unknown.
    std::span<const double> noise_variance = {};
    double noise_variance_error = 0;  ///< relative standard error of all of them together
    std::size_t failed = 0;           ///< further cases, without a value and without a row here
};

struct AssistedEstimate {
    double value = std::numeric_limits<double>::quiet_NaN();
    double half_width = std::numeric_limits<double>::quiet_NaN();  ///< 95 %
};

/// One statistic by both estimators.
struct AssistedStatistic {
    AssistedEstimate plain;            ///< pooled value, Student t over the sequences
    AssistedEstimate assisted;         ///< with scatter, as the plain one
    AssistedEstimate without_scatter;  ///< NaN where the noise is unknown
    bool takes_assisted = false;       ///< decided beforehand, see above
    /// The two with a model: it is refused, or contradicts the plain estimate of the same population.
    bool withdrawn = false;
    bool shorter = false;  ///< the assisted half-width is below the plain one: decides the next check

    [[nodiscard]] const AssistedEstimate& chosen() const { return takes_assisted ? assisted : plain; }
};

/// What scatter adds to the second to fourth central moments (law of total cumulance), in units of sd^p.
struct ScatterBudget {
    double response = std::numeric_limits<double>::quiet_NaN();  ///< of the mean response
    double scatter =
        std::numeric_limits<double>::quiet_NaN();  ///< the rest: E v; 3 cov(m, v); 6 E[(m - E m)^2 v] + 3 E[v^2]
};

struct AssistedMoments {
    std::size_t cases = 0;
    std::size_t excluded = 0;                                       ///< without a value
    double model_error = std::numeric_limits<double>::quiet_NaN();  ///< rms on left-out sequences over the sd
    bool endless = false;                                           ///< a tail of the response has no visible end
    /// Of such a response: the share of the outermost cases that the model misses, if it is too
    /// large for a model to say anything of the tail.
    std::optional<double> unforeseen = std::nullopt;
    std::array<AssistedStatistic, assisted_statistics.size()> statistics;
    std::vector<LevelEstimate> levels;    ///< with the model, of single runs; none where the model is not taken
    std::array<ScatterBudget, 3> budget;  ///< variance, third, fourth central moment; NaN where the noise is unknown
    /// Why assisted estimates were withdrawn or not taken: one sentence for each, with semicolons; empty: none was.
    std::string remark;

    [[nodiscard]] const AssistedStatistic& of(Statistic statistic) const;
};

/// `previous`: the check before, with fewer cases of the same campaign; none: the first half of the rows is that check,
/// and where it is too small for one the model's error alone decides. Rows in the order of the design's points.
/// Refuses fewer than 4 sequences, fewer than 2 max(12, 4 (d + 1)) cases, a constant response, and rare events: more
/// than half of the responses equal and fewer than 30 others. Plain errors do not hold there either.
/// Throws std::invalid_argument where sizes do not match.
[[nodiscard]] std::variant<AssistedMoments, Refusal> assisted_moments(const AssistedInput& input,
                                                                      const AssistedSettings& settings = {},
                                                                      const AssistedMoments* previous = nullptr);

}  // namespace grainsweep::stats
