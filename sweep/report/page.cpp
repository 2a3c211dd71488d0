#include "sweep/report/page.hpp"

#include "solver/plain_text.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/bracket_tables.hpp"
#include "sweep/report/calibration_tables.hpp"
#include "sweep/report/model_page.hpp"
#include "sweep/report/packed_column.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/report/table.hpp"
#include "sweep/report/watch_page.hpp"
#include "sweep/study/curves.hpp"
#include "sweep/study/effects.hpp"
#include "sweep/study/error_text.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/response_models.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

namespace grainsweep::report {

using namespace study;

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t extremes_on_page = 8;
constexpr std::size_t most_drawn_checks = 150;

/// Six digits are more than a picture shows, and half the bytes.
Json drawn(double x) {
    return std::isfinite(x) ? Json(number_in(fmt::format("{:.6g}", x)).value_or(x)) : Json(nullptr);
}

Json drawn(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double x : values) list.push_back(drawn(x));
    return list;
}

Json json_of(const History& history) {
    Json value = {{"verdict", history.verdict}, {"judged", history.has_rule}, {"notes", history.warnings}};
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    value["converged_at"] =
        history.has_rule && converged != history.checks.end() ? Json(converged->points) : Json(nullptr);
    const auto checks = checks_to_show(history, most_drawn_checks);
    value["points"] = Json::array();
    for (const auto* check : checks) value["points"].push_back(check->points);
    for (const auto statistic : stats::statistics) {
        Json& one = value["statistics"][std::string(stats::to_string(statistic))];
        const auto& all = history.all.of(statistic);
        one["text"] = with_error(all.value, all.error);
        one["values"] = Json::array();
        one["errors"] = Json::array();
        for (const auto* check : checks) {
            one["values"].push_back(drawn(check->of(statistic).value));
            one["errors"].push_back(drawn(check->of(statistic).error));
        }
    }
    value["provisional"] = nullptr;
    if (history.provisional) {
        value["notes"].push_back(provisional_line(history));
        Json& known =
            value["provisional"] = {{"points", history.provisional->points}, {"count", history.provisional->count}};
        for (const auto statistic : stats::statistics) {
            const auto& one = history.provisional->of(statistic);
            known["statistics"][std::string(stats::to_string(statistic))] = with_error(one.value, one.error);
        }
    }
    value["converged"] = to_json(history.converged);
    value["count"] = history.all.count;
    value["excluded"] = history.all.excluded;
    value["zero_share"] = drawn(history.all.zero_share);
    return value;
}

Json json_of(const Influence& influence) {
    Json value = {{"method", influence.method == Influence::Method::morris     ? "morris"
                             : influence.method == Influence::Method::saltelli ? "saltelli"
                                                                               : "given_data"},
                  {"notes", influence.notes}};
    value["factors"] = Json::array();
    for (const auto& factor : influence.factors) {
        Json one = {{"name", factor.factor},
                    {"first_text", index_text(factor.first)},
                    {"total_text", index_text(factor.total)},
                    {"first", drawn(factor.first.value)},
                    {"first_error", drawn(factor.first.half_width)},
                    {"total", drawn(factor.total.value)},
                    {"total_error", drawn(factor.total.half_width)},
                    {"trend", to_string(factor.trend)},
                    {"rank_text", with_error(factor.rank_correlation.value, factor.rank_correlation.half_width)}};
        if (factor.effects) {
            one["mu_star_text"] = with_error(factor.effects->mu_star, factor.effects->mu_star_half_width);
            one["mu_star"] = drawn(factor.effects->mu_star);
            one["mu_star_error"] = drawn(factor.effects->mu_star_half_width);
            one["sigma"] = drawn(factor.effects->sigma);
        }
        value["factors"].push_back(std::move(one));
    }
    const auto& split = influence.split;
    value["variance"] = {{"main_effects", drawn(split.main_effects.value)},
                         {"unexplained", drawn(split.unexplained.value)},
                         {"interactions", drawn(split.interactions.value)},
                         {"scatter", drawn(split.scatter.value)},
                         {"pairs", drawn(split.pairs.value)},
                         {"remainder", drawn(split.remainder.value)}};
    value["unexplained"] = unexplained_text(influence);
    return value;
}

Json json_of(const std::vector<EffectBin>& effect) {
    Json bins = Json::array();
    for (const auto& bin : effect)
        bins.push_back({drawn(bin.at), drawn(bin.mean), drawn(bin.error), bin.count, drawn(bin.pure_error)});
    return bins;
}

Json case_of(const Responses& responses, std::size_t row) {
    Json value = {
        {"point", responses.points[row]}, {"replicate", responses.replicates[row]}, {"case", responses.case_ids[row]}};
    value["factors"] = Json::array();
    for (const auto& factor : responses.factors) value["factors"].push_back(factor_text(factor, row));
    return value;
}

Json extremes_of(const Responses& responses, const ResponseColumn& response, bool largest) {
    Json list = Json::array();
    for (const auto row : extreme_rows(responses.judged(response), extremes_on_page, largest)) {
        Json one = case_of(responses, row);
        one["value"] = drawn(response.values[row]);
        list.push_back(std::move(one));
    }
    return list;
}

Json json_of(const Responses& responses, const ResponseColumn& response) {
    Json value = {{"name", response.name}, {"unit", response.unit}, {"meaning", response.meaning}};
    const auto judged = responses.judged(response);
    value["history"] = json_of(history_of(responses, response));
    const auto histogram = histogram_of(judged);
    value["histogram"] = {{"low", drawn(histogram.low)}, {"high", drawn(histogram.high)}, {"counts", histogram.counts}};
    value["effects"] = Json::array();
    const auto errors = effect_errors(responses, response);
    value["whiskers"] = errors.says;
    value["pure_error"] = drawn(errors.pure.variance);
    value["pure_error_freedom"] = errors.pure.freedom;
    for (const auto& factor : responses.factors)
        value["effects"].push_back(json_of(main_effect(factor, judged, errors)));
    value["influence"] = json_of(influence_of(responses, response));
    value["values"] = packed(response.values);
    value["largest"] = extremes_of(responses, response, true);
    value["smallest"] = extremes_of(responses, response, false);
    return value;
}

Json factors_of(const Responses& responses) {
    Json list = Json::array();
    for (const auto& factor : responses.factors) {
        list.push_back({{"name", factor.name},
                        {"unit", factor.unit},
                        {"meaning", factor.meaning},
                        {"levels", factor.levels},
                        {"low", drawn(factor.low)},
                        {"high", drawn(factor.high)},
                        {"log", factor.log},
                        {"values", packed(factor.values)}});
    }
    return list;
}

/// Every case: where it stands, what it is called, how it ended.
void add_cases(Json& value, const Responses& responses) {
    std::vector<std::string> outcomes;
    for (const auto& outcome : responses.outcomes)
        outcomes.push_back(outcome ? std::string(campaign::to_string(*outcome)) : "not yet");
    value["points"] = packed(responses.points);
    value["repeats"] = packed(responses.replicates);
    value["outcome_of"] = packed(outcomes);
    value["ids"] = packed_ids(responses.case_ids);
}

bool failed(const std::optional<campaign::Outcome>& outcome) {
    using enum campaign::Outcome;  // an abandoned case was given back and goes on with the next run
    return outcome && *outcome != completed && *outcome != skipped && *outcome != abandoned;
}

Json failures_of(const store::Store& store, const Responses& responses) {
    Json value = {{"count", std::ranges::count_if(responses.outcomes, failed)}, {"listed", Json::array()}};
    for (std::size_t row = 0; row < responses.rows(); ++row) {
        if (!failed(responses.outcomes[row])) continue;
        if (value["listed"].size() == most_listed_failures) break;
        Json one = case_of(responses, row);
        one["outcome"] = campaign::to_string(*responses.outcomes[row]);
        const auto attempts = store.attempts(responses.case_ids[row]);
        one["attempts"] = attempts.size();
        one["reason"] = attempts.empty() ? "" : attempts.back().message;
        value["listed"].push_back(std::move(one));
    }
    return value;
}

Json json_of(const Curves& curves) {
    Json value = {{"completed", curves.completed}, {"drawn", curves.drawn}, {"families", Json::array()}};
    for (const auto& family : curves.families) {
        Json one = {{"name", family.name},    {"unit", family.unit},           {"meaning", family.meaning},
                    {"over", family.over},    {"over_bins", family.over_bins}, {"at", drawn(family.at_time)},
                    {"curves", Json::array()}};
        for (const auto& curve : family.curves)
            one["curves"].push_back(
                {{"row", curve.row}, {"label", curve.label}, {"x", drawn(curve.x)}, {"y", drawn(curve.y)}});
        value["families"].push_back(std::move(one));
    }
    return value;
}

Json runs_of(const store::Store& store, const std::string& campaign) {
    return to_json(store.query(
        fmt::format("SELECT start, version, \"commit\", compiler, flags, instruction_path, processor, host, settled "
                    "FROM provenance "
                    "WHERE campaign_id = (SELECT campaign_id FROM campaign WHERE name = '{}') ORDER BY provenance_id",
                    campaign)));
}

/// One response model after the other, or why there is none.
Json models_of(const store::Store& store, const Responses& responses, const PageModels& asked) {
    Json list = Json::array();
    std::vector<std::string> names = asked.of;
    const auto* main = responses.main_observable();
    if (names.empty() && main != nullptr && responses.settled <= asked.unasked_cases) names.push_back(main->name);
    if (names.empty() || responses.settled == 0) return list;
    const auto cases = settled_cases(responses);
    if (cases.settings.empty()) return list;
    for (const auto& name : names) {
        const auto found = std::ranges::find(cases.observables, name, &ResponseColumn::name);
        if (found == cases.observables.end()) continue;
        const auto learned = learn(cases, *found);
        if (const auto* model = std::get_if<ObservableModel>(&learned))
            list.push_back(model_page_data(cases, *model, admission(store, cases)));
        else
            list.push_back({{"observable", name}, {"refused", std::get<stats::Refusal>(learned).sentence}});
    }
    return list;
}

void refuse_unknown_models(const Json& page, const PageModels& asked) {
    std::vector<std::string> names;
    for (const auto& campaign : page["campaigns"])
        for (const auto& observable : campaign["observables"])
            if (const std::string name = observable["name"]; !std::ranges::count(names, name)) names.push_back(name);
    for (const auto& name : asked.of)
        if (!std::ranges::count(names, name))
            throw campaign::wrong_question(
                "--model", fmt::format("'{}'", name),
                fmt::format("no campaign has values of such a scalar; there are {}", campaign::listed(names)),
                campaign::nearest_word(name, names));
}

Json campaign_of(const store::Store& store, const store::CampaignRecord& record, std::string_view database,
                 const PageModels& models) {
    const auto responses = read_responses(store, record);
    const SceneInfo* scene = find_scene(record.scene);
    Json value = {{"name", record.name},
                  {"database", database},
                  {"notes", campaign::remarks_in(record.text).notes},
                  {"scene", record.scene},
                  {"revision", record.revision},
                  {"summary", scene == nullptr ? "" : scene->summary},
                  {"design", record.design},
                  {"design_text", campaign::design_line(record)},
                  {"fixed_text", campaign::fixed_line(record)},
                  {"where", record.condition},
                  {"sequences", repeats(responses) ? record.sequences : 1},
                  {"replicates", record.replicates},
                  {"rows", responses.rows()},
                  {"settled", responses.settled},
                  {"settled_points", responses.counted_points()},
                  {"sample", responses.ordered_sample()},
                  {"text", record.text}};
    value["stopped_at"] = record.stopped_at ? Json(*record.stopped_at) : Json(nullptr);
    value["outcomes"] = Json::array();
    for (const auto& [outcome, count] : count_outcomes(responses)) value["outcomes"].push_back({outcome, count});
    add_cases(value, responses);
    value["factors"] = factors_of(responses);
    value["observables"] = Json::array();
    value["main"] = 0;
    const auto* main = responses.main_observable();
    for (const auto& response : responses.observables) {
        const auto finite = [](double x) { return std::isfinite(x); };
        if (&response != main && std::ranges::none_of(response.values, finite)) continue;
        if (&response == main) value["main"] = value["observables"].size();
        value["observables"].push_back(json_of(responses, response));
    }
    value["brackets"] = nullptr;
    if (const auto brackets = brackets_of(store, record)) {
        const auto table = brackets_table(*brackets);
        value["brackets"] = {{"says", brackets_line(*brackets)}, {"columns", table.columns}, {"rows", Json::array()}};
        for (const auto& row : table.rows) {
            Json cells = Json::array();
            for (const auto& cell : row) cells.push_back(to_json(cell));
            value["brackets"]["rows"].push_back(std::move(cells));
        }
    }
    value["models"] = models_of(store, responses, models);
    const auto calibration = calibration_report(store, record);
    value["calibration"] = calibration ? page_of(*calibration) : Json(nullptr);
    value["curves"] = json_of(read_curves(store, responses));
    value["failures"] = failures_of(store, responses);
    value["runs"] = runs_of(store, record.name);
    return value;
}

}  // namespace

Json page_data(std::span<const PageSource> sources, const PageModels& models) {
    Json value = {{"databases", Json::array()}, {"campaigns", Json::array()}};
    for (const auto& [store, database] : sources) {
        value["databases"].push_back(database);
        for (const auto& record : find_campaigns(*store, ""))
            value["campaigns"].push_back(campaign_of(*store, record, database, models));
    }
    refuse_unknown_models(value, models);
    return value;
}

std::string safe_in_script(const Json& value) {
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        // '<' occurs in strings only, so its escape is the same JSON; U+2028 and U+2029 end lines of a script.
        if (text[i] == '<') {
            safe += "\\u003c";
        } else if (text.compare(i, 3, "\xE2\x80\xA8") == 0 || text.compare(i, 3, "\xE2\x80\xA9") == 0) {
            safe += text[i + 2] == '\xA8' ? "\\u2028" : "\\u2029";
            i += 2;
        } else {
            safe += text[i];
        }
    }
    return safe;
}

namespace {

std::string film_script() {
    return std::string(player().program) + std::string(player().in_report);
}

/// Films, each in a script element of its own, with the player; nothing where there is none.
std::string film_elements(std::span<const PageFilm> films) {
    if (films.empty()) return {};
    const auto escaped = [](std::string_view text) {
        std::string safe;
        for (const char c : text)
            safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
        return safe;
    };
    const Player with = player();
    std::string text = fmt::format("<style>\n{}</style>\n", with.style);
    for (const auto& film : films) {
        text += fmt::format(
            R"(<script type="application/octet-stream;base64" id="watch-{0}" data-film data-campaign="{1}" )"
            R"(data-case="{0}" data-says="{2}">)",
            escaped(film.case_id), escaped(film.campaign), escaped(film.says));
        text += base64(std::span(reinterpret_cast<const std::uint8_t*>(film.bytes.data()), film.bytes.size()));
        text += "</script>\n";
    }
    return text + fmt::format("<script>{}</script>\n", film_script());
}

}  // namespace

void write_page(std::ostream& out, std::span<const PageSource> sources, std::span<const PageFilm> films,
                const PageModels& models) {
    const auto files = page_files();
    const auto data = safe_in_script(page_data(sources, models));
    const auto program = enclosed(files.program);
    const auto scripts = films.empty() ? script_sources({files.library, program})
                                       : script_sources({files.library, program, film_script()});
    fill(out, files.skeleton,
         {{"scripts", scripts},
          {"style", files.style},
          {"library", files.library},
          {"films", film_elements(films)},
          {"data", data},
          {"program", program}});
}

}  // namespace grainsweep::report
