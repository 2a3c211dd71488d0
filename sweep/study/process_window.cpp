#include "sweep/study/process_window.hpp"

#include "stats/confidence.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/designs/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace grainsweep::study {
namespace {

constexpr std::size_t candidates_of_next = 192, points_of_front = 12;
constexpr std::size_t points_about_best = 64, rounds_about_best = 8;
constexpr double first_reach = 0.15;
constexpr std::array reaches_about_front = {0.06, 0.02, 0.007};  // of the range of a factor
constexpr std::size_t centres_of_gain = 8, centres_of_front = 24, points_about_front = 24;
constexpr std::size_t share_of_doubted = 4;                // of the settings searched, one in so many
constexpr double widest_apart = 0.1, least_apart = 0.025;  // of the range of a factor
constexpr double enough_gain = 0.5;                        // of the best gain
constexpr double least_gain = 1e-4;                        // of the best gain, below which a case is not worth it
constexpr double small_error = 0.1;                        // of the range of the computed values

/// The best of the judged points, improved by points about it.
std::pair<Judgement, std::vector<Judgement>> improved(const WindowQuestion& question, std::span<const BoxPoint> points,
                                                      std::span<const Judgement> judged) {
    std::size_t start = 0;
    for (std::size_t i = 1; i < judged.size(); ++i)
        if (question.better(judged[i], judged[start])) start = i;
    BoxPoint centre = points[start];
    Judgement best = judged[start];
    std::vector<Judgement> seen;
    double reach = first_reach;
    for (std::size_t round = 0; round < rounds_about_best; ++round, reach /= 2) {
        question.report("about the best setting", static_cast<double>(round) / rounds_about_best);
        const auto near = question.space().about(centre, reach, points_about_best);
        std::vector<Setting> settings;
        for (const auto& point : near) settings.push_back(point.setting);
        auto judgements = question.judge(settings);
        for (std::size_t i = 0; i < near.size(); ++i) {
            if (!question.better(judgements[i], best)) continue;
            best = judgements[i];
            centre = near[i];
        }
        std::ranges::move(judgements, std::back_inserter(seen));
    }
    return {std::move(best), std::move(seen)};
}

/// Returns at most `count` of the indices, the first and the last among them.
std::vector<std::size_t> thinned_front(std::span<const std::size_t> front, std::size_t count = points_of_front) {
    const auto shown = std::min(front.size(), count);
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < shown; ++k)
        chosen.push_back(front[shown == 1 ? 0 : (k * (front.size() - 1) + (shown - 1) / 2) / (shown - 1)]);
    return chosen;
}

/// The second objective, or the first other observable that the condition bounds from one side.
std::optional<Goal> against_of(const WindowQuestion& question) {
    const auto& goals = question.goals();
    if (goals.size() == 2) return goals[1];
    if (goals.empty() || !question.condition()) return std::nullopt;
    for (std::size_t k = goals[0].model ? 1 : 0; k < question.models().size(); ++k)
        if (const int direction = question.condition()->direction(question.name_of_model(k)); direction != 0)
            return Goal{.sign = direction > 0 ? 1.0 : -1.0, .factor = {}, .model = k};
    return std::nullopt;
}

/// Trade-off of the objective and `against`: of the computed cases, then of predictions with a small error. Of two
/// objectives, only of settings that meet the condition. `known`: the computed settings, judged; of two objectives.
void find_front(Window& window, const WindowQuestion& question, std::span<const ComputedSetting> settings,
                std::span<const Judgement> known, std::span<const Judgement> judged) {
    const auto& goal = question.goals().front();
    const bool pair = question.goals().size() == 2;
    const auto front_of = [&](std::span<const double> first, std::span<const double> second) {
        return stats::trade_off_front(first, goal.sign > 0, second, window.against->sign > 0);
    };
    std::vector<FrontSetting> computed;
    for (const auto& one : settings) computed.push_back({one});
    std::vector<double> first, second;
    for (const auto& one : computed) {
        first.push_back(one.objective);
        second.push_back(one.against);
    }
    const auto error_allowed = [](const std::vector<double>& values) {
        return values.empty() ? 0 : small_error * (std::ranges::max(values) - std::ranges::min(values));
    };
    const double largest = error_allowed(first), largest_against = error_allowed(second);
    if (pair) {
        for (std::size_t i = 0; i < computed.size(); ++i) {
            computed[i].judged = known[i];
            const bool counts = question.meets(known[i]);
            first[i] = counts ? known[i].objectives[0].mean : std::numeric_limits<double>::quiet_NaN();
            second[i] = known[i].objectives[1].mean;
        }
        window.volume = front_volume(question, known, judged);
    }
    const auto on_front = front_of(first, second);
    for (const auto i : pair ? on_front : thinned_front(on_front)) window.computed_front.push_back(computed[i]);
    first.clear();
    second.clear();
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < judged.size(); ++i) {
        const auto& one = judged[i];
        const auto &objective = one.objectives[0],
                   &against = pair ? one.objectives[1] : one.predictions[*window.against->model];
        const double least =
            pair ? one.probability : std::min({one.answers, one.defined.front(), one.defined[*window.against->model]});
        if (!one.believed || !question.meets(least) || objective.mean_error > largest ||
            against.mean_error > largest_against)
            continue;
        usable.push_back(i);
        first.push_back(objective.mean);
        second.push_back(against.mean);
    }
    for (const auto i : thinned_front(front_of(first, second))) window.front.push_back(judged[usable[i]]);
}

/// P (x_j - x_j*) of the header; where nothing is in the window yet, P.
std::vector<double> gains_of_factor(const WindowQuestion& question, std::span<const Judgement> judged, double sign) {
    std::optional<double> best;
    for (const auto& one : judged)
        if (question.meets(one))
            best = std::max(best.value_or(sign * one.objectives[0].mean), sign * one.objectives[0].mean);
    std::vector<double> gain;
    for (const auto& one : judged)
        gain.push_back(one.probability * (best ? std::max(sign * one.objectives[0].mean - *best, 0.0) : 1));
    return gain;
}

/// Expected growth of the hypervolume, see the header.
std::vector<double> gains_of_pair(std::span<const Judgement> judged, const stats::Hypervolume& front) {
    std::vector<double> gain;
    for (const auto& one : judged) {
        const auto &first = one.objectives[0], &second = one.objectives[1];
        const double learned = std::max(stats::learned(first), stats::learned(second));
        gain.push_back(one.believed ? one.probability * learned * front.expected_gain(first, second) : 0);
    }
    return gain;
}

/// Gains of further cases. `front`: what the computed settings dominate, of two objectives.
std::vector<double> gains(const WindowQuestion& question, std::span<const Judgement> judged,
                          const std::optional<stats::Hypervolume>& front) {
    const auto& goals = question.goals();
    if (front) return gains_of_pair(judged, *front);
    if (!goals.empty() && goals[0].factor) return gains_of_factor(question, judged, goals[0].sign);
    std::vector<stats::Prediction> objective;
    std::vector<double> probability;
    for (const auto& one : judged) {
        probability.push_back(one.probability);
        if (!goals.empty()) objective.push_back(one.objectives[0]);
    }
    if (!objective.empty()) return stats::expected_improvement(objective, probability, goals[0].sign > 0);
    for (double& p : probability) p = std::min(p, 1 - p);  // where the condition is least decided
    return probability;
}

/// 95 % half-width of a share of the box: of counting, and for each model of how far the share moves if its mean lies
/// everywhere at the same end of its interval.
double share_error(const WindowQuestion& question, std::span<const Judgement> judged, double share) {
    const auto doubted = judged.first(judged.size() / share_of_doubted);
    const auto share_by = [&](auto meets) {
        return static_cast<double>(std::ranges::count_if(doubted, meets)) / static_cast<double>(doubted.size());
    };
    double below = 0, above = 0;
    for (std::size_t k = 0; k < question.models().size() && !doubted.empty(); ++k) {
        const auto at = [&](std::size_t end) {
            return share_by([&](const Judgement& one) { return question.meets(one.at_ends[2 * k + end]); });
        };
        const double here = share_by([&](const Judgement& one) { return question.meets(one); });
        const auto [low, high] = std::minmax({at(0), at(1)});
        below = std::hypot(below, std::max(here - low, 0.0));
        above = std::hypot(above, std::max(high - here, 0.0));
    }
    return std::hypot(std::max(below, above),
                      1.96 * std::sqrt(share * (1 - share) / static_cast<double>(judged.size())));
}

/// Distance of two settings of a window: the largest along a factor, in ranges; different words are 1 apart.
double apart(std::span<const ModelFactor> factors, const Setting& a, const Setting& b) {
    double largest = 0;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        if (a[j] == b[j] || (std::isnan(a[j]) && std::isnan(b[j]))) continue;
        if (std::isnan(a[j]) || std::isnan(b[j]) || factors[j].is_word()) return 1;
        const auto at = [&](double x) { return factors[j].log() ? std::log(x) : x; };
        largest = std::max(largest, std::abs(at(a[j]) - at(b[j])) / (at(factors[j].high()) - at(factors[j].low())));
    }
    return largest;
}

double distance_from(std::span<const ModelFactor> factors, const Setting& setting, std::span<const Setting> others) {
    double nearest = 1;
    for (const auto& other : others) nearest = std::min(nearest, apart(factors, setting, other));
    return nearest;
}

/// Indices of the settings of the largest gains, none a twin of another.
std::vector<std::size_t> promising(std::span<const ModelFactor> factors, std::span<const Judgement> judged,
                                   std::span<const double> gain, std::size_t count) {
    std::vector<std::size_t> order(judged.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
    std::vector<std::size_t> chosen;
    std::vector<Setting> settings;
    for (const auto i : order) {
        if (settings.size() == count) break;
        if (distance_from(factors, judged[i].setting, settings) < least_apart) continue;
        settings.push_back(judged[i].setting);
        chosen.push_back(i);
    }
    return chosen;
}

/// Adds settings about those of the largest gains and about the front of predictions.
void search_about_front(const WindowQuestion& question, const ModelCases& cases, const stats::Hypervolume& front,
                        std::vector<BoxPoint>& points, std::vector<Judgement>& judged) {
    const auto& goals = question.goals();
    for (const double reach : reaches_about_front) {
        auto centres = promising(cases.factors, judged, gains_of_pair(judged, front), centres_of_gain);
        std::vector<double> first, second;
        for (const auto& one : judged) {
            first.push_back(question.meets(one) ? one.objectives[0].mean : std::numeric_limits<double>::quiet_NaN());
            second.push_back(one.objectives[1].mean);
        }
        const auto predicted = stats::trade_off_front(first, goals[0].sign > 0, second, goals[1].sign > 0);
        std::ranges::move(thinned_front(predicted, centres_of_front), std::back_inserter(centres));
        for (const auto i : centres) {
            auto near = question.space().about(points[i], reach, points_about_front);
            std::vector<Setting> settings;
            for (const auto& point : near) settings.push_back(point.setting);
            std::ranges::move(question.judge(settings), std::back_inserter(judged));
            std::ranges::move(near, std::back_inserter(points));
        }
    }
}

/// Returns the candidate with the largest gain among those that differ most from the ones chosen (see the header);
/// empty: no candidate promises anything.
std::optional<std::size_t> most_promising(std::span<const double> gain, std::span<const double> distance) {
    const double best = gain.empty() ? 0 : std::ranges::max(gain);
    if (!(best > 0)) return std::nullopt;
    std::optional<std::size_t> found;
    for (double wanted = widest_apart; wanted >= least_apart; wanted /= 2) {
        found.reset();
        for (std::size_t i = 0; i < gain.size(); ++i)
            if (distance[i] >= wanted && gain[i] >= least_gain * best && (!found || gain[i] > gain[*found])) found = i;
        if (found && gain[*found] >= enough_gain * best) return found;
    }
    return found;
}

/// Cases to run next: the largest gain, added to the models with its predicted responses, then the next.
std::vector<Judgement> next_of(const WindowQuestion& question, const ModelCases& cases, const WindowRequest& request,
                               std::vector<Judgement> judged, std::optional<stats::Hypervolume> front) {
    std::erase_if(judged, [](const auto& one) { return !one.believed; });
    auto gain = gains(question, judged, front);
    std::vector<Setting> settings;
    for (const auto i : promising(cases.factors, judged, gain, std::max(candidates_of_next, 4 * request.next)))
        settings.push_back(judged[i].setting);
    auto models = question.models();
    std::vector<Judgement> chosen;
    std::vector<Setting> taken;
    while (chosen.size() < request.next) {
        question.report("next cases", static_cast<double>(chosen.size()) / static_cast<double>(request.next));
        const auto now = question.judge_by(models, settings);
        gain = gains(question, now, front);
        std::vector<double> distance;
        for (const auto& setting : settings) distance.push_back(distance_from(cases.factors, setting, taken));
        const auto best = most_promising(gain, distance);
        if (!best) break;
        taken.push_back(settings[*best]);
        const auto asked = question.least_known(models, settings[*best]);
        chosen.push_back(question.judge_by(models, std::span(&asked, 1)).front());
        for (std::size_t k = 0; k < models.size(); ++k)
            models[k] = models[k].with_case(asked, chosen.back().predictions[k].mean);
        if (front) front->add({now[*best].objectives[0].mean, now[*best].objectives[1].mean});
    }
    return chosen;
}

/// Adds notes on failed cases for the window and the chosen setting.
void say_what_failed(Window& window, const ModelCases& cases) {
    if (cases.cases_left_out > 0)
        window.notes.push_back(fmt::format("{} failed cases are left out as no property of the process: {}",
                                           cases.cases_left_out, left_out_text(cases)));
    if (cases.failed.empty()) return;
    window.notes.push_back(
        fmt::format("{}; in {:.1f} % of {} a case has an answer with a probability below {:.6g}, where no setting is "
                    "counted or recommended",
                    failed_text(cases), 100 * window.share_failed, share_of(cases.factors), 1 - window.risk));
    for (const auto& test : window.answers->tests(cases)) window.notes.push_back(test.text());
    if (const auto& chosen = window.best ? window.best : window.surest)
        window.notes.push_back(fmt::format(
            "{} a case has an answer with probability {:.3f} (95 %: {:.3f} to {:.3f}); {}",
            window.best ? "at the best setting" : "where the condition is likeliest", chosen->answers,
            chosen->answers_low, chosen->answers_high, near_text(cases, window.answers->near(chosen->setting))));
}

/// No failed case among a sample of the box is no proof that none fails.
void say_what_none_failed(Window& window, const ModelCases& cases) {
    const auto* design = designs::find_design(cases.campaign.design);
    if (!cases.failed.empty() || cases.cases_left_out > 0 || design == nullptr ||
        design->beginning != designs::Beginning::sample)
        return;
    const auto count = std::ssize(cases.settings);
    window.notes.push_back(
        fmt::format("none of {} cases failed: up to {:.2g} % of the box may fail all the same (95 %)", count,
                    100 * stats::largest_unseen_share(count)));
}

void say_what_was_found(Window& window, const WindowRequest& request) {
    if (!window.best && window.surest)
        window.notes.push_back(fmt::format(
            "the condition holds nowhere with probability {}; where it is most likely it holds with probability {:.3f}",
            1 - request.risk, window.surest->probability));
    if (window.best && !request.objectives.empty())
        window.notes.emplace_back(
            "a search favours errors in its favour: run the best setting with several seeds before relying on it");
    for (const auto& model : window.models)
        if (model.undefined > 0)
            window.notes.push_back(fmt::format(
                "'{}' is undefined in {} of {} cases that have an answer, such as a jam: there it counts as "
                "beyond any limit and the condition does not hold; how likely that is comes from where "
                "cases have it and where not",
                model.observable, model.undefined, model.undefined + model.cases()));
    if (request.next > window.next.size())
        window.notes.push_back(
            fmt::format("{} of {} next cases: no further one that differs from them promises anything",
                        window.next.size(), request.next));
}

}  // namespace

Window window_of(const store::Store& store, const ModelCases& cases, const WindowRequest& request) {
    if (request.where.empty() && request.objectives.empty())
        throw campaign::input_error("window", "", "give a condition by --where, or --maximize or --minimize NAME");
    if (!(request.risk > 0 && request.risk < 1))
        throw campaign::input_error("--risk", fmt::format("{}", request.risk), "must lie between 0 and 1");
    const WindowQuestion question(cases, request, admission(store, cases));
    auto points = question.space().spread(question.space().averages() ? request.candidates / 4 : request.candidates);
    if (points.empty())
        throw campaign::input_error("window", "", "the campaign's `where` leaves no setting of the box");
    Window window;
    window.risk = request.risk;
    window.models = question.models();
    window.answers = question.answers();
    window.goals = question.goals();
    window.against = against_of(question);
    for (const auto& point : points) window.searched.push_back(point.setting);
    auto judged = question.judge(window.searched, "settings of the box", window.searched.size() / share_of_doubted);

    if (std::ranges::none_of(judged, [](const auto& one) { return one.answers >= 0.5; }))
        throw campaign::input_error("window", "",
                                    fmt::format("{}, and at every setting of the box a case is likelier to fail "
                                                "than not: none can be recommended",
                                                failed_text(cases)));
    const auto share = [&](const auto& is) {
        return static_cast<double>(std::ranges::count_if(judged, is)) / static_cast<double>(judged.size());
    };
    window.share_failed = share([&](const Judgement& one) { return one.answers < 1 - request.risk; });
    window.share_of_box = share([&](const Judgement& one) { return question.meets(one); });
    const auto share_with = [&](auto answers) {
        return share([&](const Judgement& one) {
            return one.answers > 0 && one.probability * answers(one) / one.answers >= 1 - request.risk;
        });
    };
    const double low = share_with([](const Judgement& one) { return one.answers_low; });
    const double high = share_with([](const Judgement& one) { return one.answers_high; });
    window.share_error = std::hypot(share_error(question, judged, window.share_of_box), (high - low) / 2);
    window.share_low = std::max(0.0, window.share_of_box - window.share_error);
    window.share_high = std::min(1.0, window.share_of_box + window.share_error);
    auto [best, seen] = improved(question, points, judged);
    (question.meets(best) ? window.best : window.surest) = best;
    std::optional<stats::Hypervolume> front;
    if (window.against) {
        const auto computed = computed_settings(cases, question, window.goals[0], *window.against);
        std::vector<Judgement> known;
        if (window.goals.size() == 2) {
            known = judge_computed(question, computed);
            front = dominated(question, known);
            search_about_front(question, cases, *front, points, judged);
        }
        find_front(window, question, computed, known, judged);
    }
    window.batches = standings(cases, question);
    if (request.next > 0) {
        std::ranges::move(seen, std::back_inserter(judged));
        window.next = next_of(question, cases, request, std::move(judged), std::move(front));
    }
    say_what_failed(window, cases);
    if (const auto noise = question.space().noise_names(); !noise.empty())
        window.notes.push_back(fmt::format("{} cannot be set: probabilities and responses are averages over {}",
                                           campaign::listed(noise), noise.size() == 1 ? "it" : "them"));
    say_what_was_found(window, request);
    say_what_none_failed(window, cases);
    return window;
}

std::vector<Judgement> judge_settings(const ModelCases& cases, const WindowRequest& request, const Window& window,
                                      const Admits& admits, std::span<const Setting> settings) {
    return WindowQuestion(cases, request, admits, window.models, window.answers).judge(settings);
}

std::string next_campaign(const ModelCases& cases, const Window& window, std::string_view name, std::uint64_t number) {
    std::vector<std::vector<Value>> rows;
    for (const auto& one : window.next) {
        auto& row = rows.emplace_back();
        const auto listed = as_seen(cases.factors, one.setting);  // a list has values of the ranges
        for (std::size_t j = 0; j < cases.factors.size(); ++j) row.push_back(cases.factors[j].value_of(listed[j]));
    }
    return campaign::further_points(
        campaign::text_of_experiment(cases.campaign.text, cases.campaign), name,
        fmt::format("The cases that the response models of {} promise most of, by grainsweep window --next {}.",
                    cases.campaign.name, rows.size()),
        rows, number);
}

}  // namespace grainsweep::study
