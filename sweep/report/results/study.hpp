// Fields of converge and sensitivity.
#pragma once

#include "sweep/report/results/models.hpp"

namespace grainsweep::report::results {

// ---- converge

inline constexpr auto judged_estimate = std::to_array<Field>({
    {"value", number, "estimate from all settled points"},
    {"error", number, "95 % half-width"},
    amount("measure", "1", "size of the error that the rule compares with the tolerance"),
});
inline constexpr auto judged_moments =
    std::to_array<Field>({holding({"NAME", object, "mean, sd, skewness, g1 or kurtosis"}, judged_estimate)});
inline constexpr auto moments =
    std::to_array<Field>({holding({"NAME", object, "mean, sd, skewness, g1 or kurtosis"}, estimate)});
inline constexpr auto provisional_moments = std::to_array<Field>({
    {"points", whole, "points with a finished case"},
    {"values", whole, "cases with a value"},
    excluded_cases,
    holding({"statistics", object, "moments"}, moments),
});
inline constexpr auto check = std::to_array<Field>({
    campaign_name,
    observable_name,
    {"points", whole, "points of the design up to this check"},
    {"mean", number, "mean"},
    {"sd", number, "standard deviation"},
    {"skewness", number, "Pearson's skewness, from mean and median"},
    {"g1", number, "moment skewness"},
    {"kurtosis", number, "kurtosis; 3: normal"},
    {"mean_error", number, "95 % half-width"},
    {"sd_error", number, "95 % half-width"},
    {"skewness_error", number, "95 % half-width"},
    {"g1_error", number, "95 % half-width"},
    {"kurtosis_error", number, "95 % half-width"},
    amount("zero_share", "1", "share of values that are 0"),
    excluded_cases,
    {"converged", whole, "1: converged at this check"},
    {"provisional", whole, "1: of all finished cases, not judged"},
});
inline constexpr auto lattice_step = std::to_array<Field>({
    campaign_name,
    {"points", whole, "points of the lattice"},
    {"values", whole, "cases with a value"},
    {"NAME", number, "moment; NAME_change: its change from the coarser lattice, as the rule compares it"},
});
inline constexpr auto level = std::to_array<Field>({
    {"statistic", text, "quantile:P, above:T or below:T"},
    {"value", number, "quantile, or probability"},
    {"error", number, "95 % half-width"},
    amount("measure", "1", "size of the error that a rule compares with the tolerance"),
    holding({"model_assisted", object, "estimate with a response model; null: none"}, estimate),
    {"of_all_cases", vector, "limits of a probability, wherever cases without a value lie"},
});
inline constexpr auto assisted_estimate = joined(estimate, std::to_array<Field>({
                                                               {"taken", flag, "whether it replaces the plain one"},
                                                               {"withdrawn", flag, "whether the model is wrong"},
                                                           }));
inline constexpr auto assisted_moments =
    std::to_array<Field>({holding({"NAME", object, "mean, sd, g1 or kurtosis"}, assisted_estimate)});
inline constexpr auto estimate_without_scatter =
    joined(estimate, std::to_array<Field>({{"withdrawn", flag, "whether the model is wrong"}}));
inline constexpr auto moments_without_scatter =
    std::to_array<Field>({holding({"NAME", object, "mean, sd, g1 or kurtosis"}, estimate_without_scatter)});
inline constexpr auto scatter_shares = std::to_array<Field>({
    amount("variance", "1", "share of the variance"),
    amount("third_moment", "1", "share of the third central moment"),
    amount("fourth_moment", "1", "share of the fourth central moment"),
});
inline constexpr auto estimators = std::to_array<Field>({
    holding({"plain", object, "moments of the cases alone"}, moments),
    holding({"model_assisted", object, "moments with a response model; null: refused"}, assisted_moments),
    holding({"without_scatter", object, "moments of the mean response; null: the scatter is unknown"},
            moments_without_scatter),
    amount("model_error", "1", "error at left-out sequences divided by the standard deviation"),
    {"features", words, "expressions of factors that the model uses"},
    {"scatter_from", text, "replicates, or the observable that states the scatter"},
    holding({"scatter_share", object, "parts due to the scatter of single runs; null: unknown"}, scatter_shares),
    {"note", text, "why the model was refused, or a remark on it"},
    {"population", text, "sentence on cases without a value; empty: none"},
});
inline constexpr auto corrected_moment = std::to_array<Field>({
    {"value", number, "corrected value"},
    {"error", number, "95 % half-width: numerics and statistics together"},
    {"numerics", number, "95 % half-width from the numerics"},
    {"statistics", number, "95 % half-width from the number of cases"},
    {"uncorrected", number, "value of the cheaper setting alone"},
});
inline constexpr auto corrected_moments =
    std::to_array<Field>({holding({"NAME", object, "mean or sd"}, corrected_moment)});
inline constexpr auto corrected = std::to_array<Field>({
    observable_name,
    {"setting", text, "setting of most cases"},
    {"cases", whole, "cases at this setting"},
    {"pairs", whole, "points computed at `reference`, too"},
    amount("tolerance", "1", "largest relative error"),
    {"within", flag, "whether the error is within the tolerance"},
    amount("core_seconds", "s", "core time of all cases"),
    amount("alone_core_seconds", "s", "core time of the same accuracy by `reference` alone"),
    holding({"statistics", object, "moments of the setting `reference`"}, corrected_moments),
});
inline constexpr auto converge = std::to_array<Field>({
    campaign_name,
    observable_name,
    observable_unit,
    {"design", text, "design of the campaign"},
    {"points", whole, "settled points, from the first on"},
    {"values", whole, "cases with a value at these points"},
    excluded_cases,
    amount("zero_share", "1", "share of values that are 0"),
    candidate_points,
    dropped_points,
    {"asked", whole, "cases of the last run"},
    {"finished", whole, "cases with a result"},
    holding({"provisional", object, "all finished cases, if some are behind a gap"}, provisional_moments),
    {"rule", word, "convergence rule; null: none"},
    amount("tolerance", "1", "tolerance of the rule"),
    {"gates", words, "statistics that the rule judges"},
    holding({"statistics", object, "moments"}, judged_moments),
    {"converged", flag, "whether the campaign has converged by its rule"},
    {"converged_at", whole, "points at which it converged"},
    {"held_back_by", text, "statistic that delays the convergence"},
    {"points_needed", whole, "points at which it will probably converge"},
    {"verdict", text, "sentence on the convergence"},
    notes_to_read,
    holding({"checks", array, "one per check, then all settled points"}, check),
    sometimes(holding({"lattices", array, "lattices of the same factors, if there are several"}, lattice_step)),
    holding({"distribution", array, "quantiles and probabilities"}, level),
    holding({"estimators", object, "moments by two estimators"}, estimators),
    sometimes(holding({"corrected", object, "result of a campaign with an error goal"}, corrected)),
});

// ---- converge, of a search for a threshold crossing

inline constexpr auto bracket_end = std::to_array<Field>({
    {"value", number, "value of the factor"},
    {"mean", number, "mean of the observable"},
    {"error", number, "95 % half-width of the mean"},
    {"runs", whole, "runs with an answer"},
    {"unanswered", whole, "runs without an answer"},
});
inline constexpr auto level_words = std::to_array<Field>({{"NAME", text, "level of another factor"}});
inline constexpr auto bracket = std::to_array<Field>({
    holding({"levels", object, "levels of the other factors"}, level_words),
    holding({"low", object, "lower end of the bracket"}, bracket_end),
    holding({"high", object, "upper end of the bracket"}, bracket_end),
    {"runs", whole, "runs of this combination"},
    {"state", word, "open, found, below, above (no crossing in the range) or unanswered"},
});
inline constexpr auto crossings = std::to_array<Field>({
    campaign_name,
    {"factor", text, "factor along which the threshold is crossed"},
    observable_name,
    {"threshold", number, "value that the observable crosses"},
    {"width", number, "requested width of a bracket"},
    holding({"brackets", array, "one per combination of levels"}, bracket),
});

// ---- converge, of a calibration

inline constexpr auto wave = std::to_array<Field>({
    {"settings", whole, "settings of the wave"},
    {"cases", whole, "cases so far"},
    {"failed", whole, "settings so far without an answer to some target"},
    {"excluded", whole, "settings so far that `where` excludes"},
    amount("kept", "1", "share of the box that is not ruled out"),
    {"model_errors", vector, "rms error of each target's model divided by the standard deviation"},
});
inline constexpr auto level_probability = std::to_array<Field>({
    {"level", text, "level"},
    amount("probability", "1", "posterior probability"),
});
inline constexpr auto factor_posterior = std::to_array<Field>({
    factor_name,
    {"mean", number, "posterior mean"},
    {"sd", number, "posterior standard deviation"},
    {"q05", number, "5 % quantile"},
    {"q95", number, "95 % quantile"},
    amount("share_of_range", "1", "width of the posterior divided by the prior's"),
    {"verdict", word, "determined, partly or not determined"},
    holding({"levels", array, "one per level; empty: a range"}, level_probability),
});
inline constexpr auto target_check = std::to_array<Field>({
    {"experiment", text, "name of the experiment; empty: there is only one"},
    observable_name,
    {"condition", text, "inputs of the measurement"},
    {"value", number, "measured value"},
    {"error", number, "standard error of the measurement"},
    {"discrepancy", number, "standard deviation that is allowed to the scene"},
    {"predicted", number, "mean of the model over the posterior"},
    {"predicted_sd", number, "standard deviation of the model over the posterior"},
    {"checked", number, "mean of the fresh runs"},
    {"checked_sd", number, "standard deviation of the fresh runs"},
    {"runs", whole, "fresh runs"},
    {"z", number, "distance of the fresh runs from the measurement, in standard deviations"},
});
inline constexpr auto calibration = std::to_array<Field>({
    campaign_name,
    {"ended", flag, "whether the waves have ended"},
    {"why", text, "why they ended"},
    {"verdict", text, "result in one line; null: not yet"},
    holding({"waves", array, "one per wave"}, wave),
    holding({"posterior", array, "one per factor"}, factor_posterior),
    {"correlation", array, "correlation of the factors, row by row; empty: no posterior"},
    holding({"targets", array, "one per measurement"}, target_check),
    notes_to_read,
});
inline constexpr auto calibration_beside = std::to_array<Field>({
    campaign_name,
    {"shown_with", text, "campaign that shows the calibration over all experiments"},
});

// ---- sensitivity

inline constexpr auto factor_influence = std::to_array<Field>({
    {"name", text, "name of the factor or group"},
    sometimes({"members", words, "factors of the group"}),
    sometimes({"bins", whole, "bins of the first-order index"}),
    sometimes(holding({"first", object, "first-order index: share of the variance due to the factor alone"}, estimate)),
    sometimes(holding({"first_saltelli", object, "the same by Saltelli et al. 2010"}, estimate)),
    sometimes(holding({"total", object, "total index: with all interactions"}, estimate)),
    sometimes(holding({"mu_star", object, "mean absolute elementary effect"}, estimate)),
    sometimes({"mu", number, "mean elementary effect"}),
    sometimes({"sigma", number, "standard deviation of the elementary effects"}),
    {"trend", word, "rises, falls or bends; null: unknown"},
    holding({"rank_correlation", object, "Spearman's rank correlation"}, estimate),
});
inline constexpr auto variance_split = std::to_array<Field>({
    holding({"main_effects", object, "share of the factors alone, by a sum of curves"}, estimate),
    holding({"unexplained", object, "the rest: interactions and scatter"}, estimate),
    holding({"interactions", object, "share of interactions, with replicates"}, estimate),
    holding({"scatter", object, "share of the scatter of single runs, with replicates"}, estimate),
    {"interactions_of_two", value, "null; see `model`"},
    {"scatter_and_higher", value, "null; see `model`"},
    {"pure_error", number, "variance between replicates, in the unit of the observable squared"},
    {"pure_error_freedom", whole, "degrees of freedom of the pure error"},
});
inline constexpr auto model_index = std::to_array<Field>({
    {"name", text, "name of the factor"},
    sometimes(holding({"shapley", object, "Shapley effect, of factors that depend on each other"}, estimate)),
    sometimes(holding({"first", object, "first-order index"}, estimate)),
    sometimes(holding({"total", object, "total index"}, estimate)),
    sometimes(holding({"interactions", object, "total less first order"}, estimate)),
});
inline constexpr auto pair_index =
    joined(std::to_array<Field>({{"factors", words, "names of the two factors"}}), estimate);
inline constexpr auto noise_control = joined(std::to_array<Field>({
                                                 {"name", text, "name of the control factor"},
                                                 {"where", text, "part of its range where the noise is smallest"},
                                                 {"significant", flag, "whether the reduction exceeds its error"},
                                             }),
                                             estimate);
inline constexpr auto noise_share =
    joined(std::to_array<Field>({
               {"factors", words, "noise factors"},
               holding({"controls", array, "control factors, the most effective first"}, noise_control),
           }),
           estimate);
inline constexpr auto model_influence = std::to_array<Field>({
    holding({"factors", array, "one per factor"}, model_index),
    holding({"pairs", array, "interaction of every pair of factors"}, pair_index),
    amount("scatter_share", "1", "share of the scatter in the variance of single runs"),
    amount("unexplained_share", "1", "share that the model does not explain"),
    holding({"response_model", object, "the model; null: refused"}, model),
    holding({"noise", object, "share of the noise factors; null: none"}, noise_share),
    {"refused", text, "why there is no model; null: there is one"},
});
inline constexpr auto sensitivity = std::to_array<Field>({
    campaign_name,
    observable_name,
    {"method", word, "given_data, saltelli or morris"},
    {"used", whole, "cases; of saltelli rows, of morris effects of a factor"},
    excluded_cases,
    holding({"factors", array, "one per factor or group"}, factor_influence),
    holding({"variance", object, "parts of the variance of single runs"}, variance_split),
    notes_to_read,
    holding({"model", object, "indices by a response model"}, model_influence),
});

}  // namespace grainsweep::report::results
