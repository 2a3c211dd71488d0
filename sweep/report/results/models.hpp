// Fields of predict, window and accuracy.
#pragma once

#include "sweep/report/results/shared.hpp"

namespace grainsweep::report::results {

// ---- quality of a model

inline constexpr auto response_quality = std::to_array<Field>({
    amount("leave_one_out_error", "1", "rms error at left-out cases divided by the standard deviation"),
    amount("coverage_50", "1", "share of left-out cases in their 50 % interval"),
    amount("coverage_95", "1", "share of left-out cases in their 95 % interval"),
    amount("noise_share", "1", "share of the variance that is scatter of single runs"),
    {"learned_map", flag, "whether a linear map of the features is learned"},
});
inline constexpr auto probability_quality = std::to_array<Field>({
    {"ones", whole, "cases with the value 1"},
    amount("brier", "1", "mean square of left-out values less their probability"),
    amount("brier_of_share", "1", "the same with the share of ones as probability"),
});
inline constexpr auto model_basis = std::to_array<Field>({
    observable_name,
    {"kind", word, "response, or probability of a 1"},
    {"cases", whole, "cases with a value"},
    {"rests_on", whole, "cases in the model"},
    {"undefined", whole, "answered cases without a value"},
    {"features", words, "expressions of factors that the model uses"},
    notes_to_read,
});
inline constexpr auto model = [] {
    auto all = joined(model_basis, joined(response_quality, probability_quality));
    for (auto& one : std::span(all).subspan(model_basis.size())) one.optional = true;
    return all;
}();

// ---- predict

inline constexpr auto mean_and_scatter = std::to_array<Field>({
    {"mean", number, "predicted mean over seeds"},
    {"mean_error", number, "standard error of the mean"},
    {"scatter", number, "standard deviation of single runs"},
});
inline constexpr auto answers_there = std::to_array<Field>({
    amount("answers", "1", "probability that a case has an answer"),
    amount("answers_low", "1", "lower end of its 95 % interval"),
    amount("answers_high", "1", "upper end of its 95 % interval"),
    {"near_cases", whole, "nearest cases that were compared"},
    {"near_failed", whole, "failed cases among them"},
});
inline constexpr auto prediction = joined(std::to_array<Field>({
                                              inputs,
                                              {"mean_low", number, "lower end of the 95 % interval of the mean"},
                                              {"mean_high", number, "upper end of the 95 % interval of the mean"},
                                              {"inside", flag, "whether the setting is in the ranges of the factors"},
                                              amount("defined", "1", "probability that the observable has a value"),
                                          }),
                                          joined(mean_and_scatter, answers_there));
inline constexpr auto predict = std::to_array<Field>({
    campaign_name,
    observable_name,
    holding({"points", array, "one per setting; null where a case is likelier to fail"}, prediction),
    holding({"model", object, "model of the response"}, model),
});

// ---- window

inline constexpr auto window_objective = std::to_array<Field>({
    sometimes({"observable", text, "name, if it is an observable"}),
    sometimes({"factor", text, "name, if it is a factor"}),
    {"maximize", flag, "whether the largest value is the best"},
    sometimes({"reference", number, "of two objectives: value that counts as no gain"}),
});
inline constexpr auto window_observables =
    std::to_array<Field>({holding({"NAME", object, "prediction of an observable"}, mean_and_scatter)});
inline constexpr auto window_setting = [] {
    auto all = joined(joined(mean_and_scatter, answers_there),
                      std::to_array<Field>({
                          inputs,
                          amount("probability", "1", "probability that the condition holds"),
                          holding({"observables", object, "one per model"}, window_observables),
                      }));
    for (auto& one : std::span(all).first(mean_and_scatter.size())) one.optional = true;  // without an objective
    return all;
}();
inline constexpr auto front_values =
    std::to_array<Field>({{"NAME", number, "value of an objective, averaged over the runs"}});
inline constexpr auto front_mean = std::to_array<Field>({
    {"mean", number, "mean by the model"},
    {"mean_error", number, "standard error of the mean"},
});
inline constexpr auto front_means = std::to_array<Field>({holding({"NAME", object, "objective"}, front_mean)});
inline constexpr auto computed_setting = std::to_array<Field>({
    inputs,
    {"runs", whole, "runs of the setting"},
    holding({"observables", object, "objectives that are observables"}, front_values),
    sometimes(holding({"means", object, "of two objectives: means by the models"}, front_means)),
    sometimes(amount("probability", "1", "of two objectives: probability that the condition holds")),
});
inline constexpr auto hypervolume = std::to_array<Field>({
    {"value", number, "hypervolume that the computed front dominates"},
    {"error", number, "95 % half-width"},
    {"further", number, "hypervolume that the best front may dominate beyond it, at most"},
});
inline constexpr auto batch_best = joined(std::to_array<Field>({inputs}), front_mean);
inline constexpr auto batch = std::to_array<Field>({
    campaign_name,
    {"cases", whole, "answered cases that no earlier campaign has"},
    sometimes(holding({"best", object, "best computed setting up to this campaign"}, batch_best)),
    sometimes({"hypervolume", number, "of two objectives: hypervolume up to this campaign"}),
    sometimes({"hypervolume_error", number, "95 % half-width of the hypervolume"}),
});
inline constexpr auto window_run = std::to_array<Field>({
    {"cases", whole, "cases of the run"},
    {"batches", whole, "batches of the run"},
    {"reached", flag, "whether the width or tolerance is reached"},
    {"says", text, "sentence on how the run ended"},
});
inline constexpr auto window = std::to_array<Field>({
    campaign_name,
    {"where", text, "condition; empty: it holds everywhere"},
    holding({"objective", object, "first objective; null: none"}, window_objective),
    holding({"objectives", array, "at most two"}, window_objective),
    amount("risk", "1", "largest probability that a setting in the window violates the condition"),
    {"judged", word, "mean or single_run: what the condition is applied to"},
    amount("share_of_box", "1", "share of the settings that are in the window"),
    amount("share_error", "1", "95 % half-width of this share"),
    amount("share_low", "1", "lower end of its 95 % interval"),
    amount("share_high", "1", "upper end of its 95 % interval"),
    amount("share_failed", "1", "share of the settings where an answer is too unlikely"),
    holding({"best", object, "best setting in the window; null: none"}, window_setting),
    holding({"surest", object, "setting of largest probability, if there is no best one"}, window_setting),
    holding({"computed_front", array, "computed settings that no other beats"}, computed_setting),
    holding({"front", array, "predicted settings that no other beats"}, window_setting),
    holding({"hypervolume", object, "of two objectives"}, hypervolume),
    holding({"batches", array, "state of a search after each of its campaigns"}, batch),
    holding({"next", array, "settings to run next"}, window_setting),
    holding({"models", array, "one per observable"}, model),
    notes_to_read,
    sometimes(holding({"run", object, "with `--run`"}, window_run)),
});

// ---- accuracy

inline constexpr auto bias = std::to_array<Field>({
    observable_name,
    observable_unit,
    {"pairs", whole, "points with an answer at both settings"},
    {"mean", number, "mean of the most accurate setting at these points"},
    {"bias", number, "mean difference from the most accurate setting"},
    {"bias_error", number, "95 % half-width of the bias"},
    {"scatter", number, "standard deviation of the differences"},
    {"spread", number, "standard deviation of the answers"},
    amount("relative_bound", "1", "absolute bias and its error divided by the absolute mean"),
});
inline constexpr auto numerics = std::to_array<Field>({
    {"setting", text, "setting of the numerics, in words"},
    campaign_name,
    {"cases", whole, "cases of the campaign"},
    {"answered", whole, "cases with an answer"},
    amount("core_seconds", "s", "mean processor time of a case with an answer"),
    holding({"biases", array, "one per observable"}, bias),
});
inline constexpr auto accuracy = std::to_array<Field>({
    campaign_name,
    amount("tolerance", "1", "largest relative error"),
    {"observables", words, "observables that are judged"},
    {"cheapest", text, "cheapest setting within the tolerance; null: only the most accurate one"},
    holding({"settings", array, "one per setting, the most accurate last"}, numerics),
});

}  // namespace grainsweep::report::results
