#include "sweep/report/page.hpp"

#include "solver/plain_text.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/report/figure_kinds.hpp"
#include "sweep/report/findings.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/report/model_page.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/packed_column.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/print_axes.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/study/curves.hpp"
#include "sweep/study/effects.hpp"
#include "sweep/study/error_text.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/response_models.hpp"

#include <fmt/format.h>
#include <array>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <ostream>
#include <utility>

namespace grainsweep::report {

using namespace study;

namespace {

constexpr std::size_t extremes_on_page = 8;

/// Six digits are more than a picture shows, and half the bytes.
Json drawn(double x) {
    return std::isfinite(x) ? number_in(fmt::format("{:.6g}", x)).value_or(x) : x;
}

Json drawn(const std::vector<double>& values) {
    return Json::list(values, [](double x) { return drawn(x); });
}

/// Figures of a campaign as SVG, by response and name; those of the campaign itself without a response.
using Drawings = std::map<std::string, Json>;

void add_figures(Drawings& drawings, const std::string& response, const NamedFigures& figures) {
    auto& all = drawings[response];
    for (const auto& [name, figure] : figures) all.add(name, plot::drawn(figure, figure_width_mm, plot::FileType::svg));
}

Json page_json(const History& history) {
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    Json statistics = Json::object(), known_statistics = Json::object(), known;
    for (const auto statistic : stats::statistics) {
        const auto& all = history.all.of(statistic);
        statistics.add(stats::to_string(statistic), with_error(all.value, all.error));
    }
    auto notes = history.warnings;
    if (history.provisional) {
        notes.push_back(provisional_line(history));
        for (const auto statistic : stats::statistics) {
            const auto& one = history.provisional->of(statistic);
            known_statistics.add(stats::to_string(statistic), with_error(one.value, one.error));
        }
        known = {{"points", history.provisional->points},
                 {"count", history.provisional->count},
                 {"statistics", known_statistics}};
    }
    const auto level_row = [](const auto& one) {
        const auto* quantile = std::get_if<stats::Quantile>(&one.first);
        const auto title = quantile == nullptr ? stats::to_string(one.first)
                                               : fmt::format("{:.6g} % quantile", 100 * quantile->probability);
        return Json{{"title", title},
                    {"has_unit", quantile != nullptr},
                    {"text", with_error(one.second.value, one.second.error)}};
    };
    return {{"verdict", history.verdict},
            {"levels", Json::list(history.all.levels, level_row)},
            {"judged", history.has_rule},
            {"notes", notes},
            {"converged_at", history.has_rule && converged != history.checks.end() ? Json(converged->points) : Json()},
            {"statistics", statistics},
            {"provisional", known},
            {"count", history.all.count},
            {"excluded", history.all.excluded},
            {"zero_share", drawn(history.all.zero_share)}};
}

Json page_json(const Influence& influence) {
    const auto json_of_factor = [](const FactorInfluence& factor) {
        Json one = {{"name", factor.factor},
                    {"first_text", index_text(factor.first)},
                    {"total_text", index_text(factor.total)},
                    {"trend", to_string(factor.trend)},
                    {"rank_text", with_error(factor.rank_correlation.value, factor.rank_correlation.half_width)}};
        if (factor.effects)
            one.add({{"mu_star_text", with_error(factor.effects->mu_star, factor.effects->mu_star_half_width)},
                     {"sigma", drawn(factor.effects->sigma)}});
        return one;
    };
    return shown_of(influence.method)
        .add({{"notes", influence.notes},
              {"factors", Json::list(influence.factors, json_of_factor)},
              {"unexplained", unexplained_text(influence)}});
}

Json case_of(const Responses& responses, std::size_t row) {
    return {{"point", responses.points[row]},
            {"case", responses.case_ids[row]},
            {"factors", Json::list(responses.factors, [&](const auto& factor) { return factor_text(factor, row); })}};
}

Json extremes_of(const Responses& responses, const ResponseColumn& response, bool largest) {
    return Json::list(extreme_rows(responses.judged(response), extremes_on_page, largest), [&](std::size_t row) {
        return case_of(responses, row)
            .add({{"replicate", responses.replicates[row]}, {"value", drawn(response.values[row])}});
    });
}

Json page_json(const store::Store& store, const Responses& responses, const ResponseColumn& response,
               Drawings& drawings) {
    const auto errors = effect_errors(responses, response);
    const auto history = history_of(responses, response, study::shown_levels);
    const auto influence = influence_of(responses, response);
    const auto means = [&, judged = responses.judged(response)](const FactorColumn& factor) {
        return Json::list(main_effect(factor, judged, errors), [](const EffectBin& bin) {
            return drawn(std::vector{bin.at, bin.mean});
        });
    };
    FigureSubject subject{store, responses, response};
    subject.history = &history;
    subject.influence = &influence;
    add_figures(drawings, response.name, panels_on_page(subject, OnPage::response));
    return {{"name", response.name},
            {"unit", response.unit},
            {"log", spans_decades(finite_range(response.values))},
            {"meaning", response.meaning},
            {"history", page_json(history)},
            {"order", Json::list(by_influence(subject), [](const auto* factor) { return factor->name; })},
            {"means", Json::list(responses.factors, means)},
            {"whiskers", errors.says},
            {"pure_error", drawn(errors.pure.variance)},
            {"pure_error_freedom", errors.pure.freedom},
            {"influence", page_json(influence)},
            {"values", packed(response.values)},
            {"largest", extremes_of(responses, response, true)},
            {"smallest", extremes_of(responses, response, false)}};
}

Json factors_of(const Responses& responses) {
    return Json::list(responses.factors, [](const FactorColumn& factor) {
        const auto [low, high] = factor.continuous() ? factor.ends() : std::pair(0.0, 0.0);
        return Json{{"name", factor.name},       {"unit", factor.unit},
                    {"meaning", factor.meaning}, {"levels", factor.seen_texts()},
                    {"low", drawn(low)},         {"high", drawn(high)},
                    {"log", factor.log()},       {"values", packed(factor.values)}};
    });
}

/// Returns place, name and outcome of every case.
Json cases_of(const Responses& responses) {
    std::vector<std::string> outcomes;
    for (const auto& outcome : responses.outcomes)
        outcomes.push_back(outcome ? std::string(campaign::to_string(*outcome)) : "not yet");
    return {{"points", packed(responses.points)},
            {"repeats", packed(responses.replicates)},
            {"outcome_of", packed(outcomes)},
            {"ids", packed_ids(responses.case_ids)}};
}

Json failures_of(const store::Store& store, const Responses& responses) {
    Json listed = Json::array();
    for (std::size_t row = 0, count = 0; row < responses.rows() && count < most_listed_failures; ++row) {
        if (!has_failed(responses.outcomes[row])) continue;
        ++count;
        const auto attempts = store.attempts(responses.case_ids[row]);
        listed.push_back(case_of(responses, row)
                             .add({{"outcome", campaign::to_string(*responses.outcomes[row])},
                                   {"attempts", attempts.size()},
                                   {"reason", attempts.empty() ? "" : attempts.back().message}}));
    }
    return {{"count", std::ranges::count_if(responses.outcomes, has_failed)}, {"listed", listed}};
}

Json page_json(const Curves& curves) {
    const auto json_of_curve = [](const Curve& curve) {
        return Json{{"row", curve.row}, {"label", curve.label}, {"x", drawn(curve.x)}, {"y", drawn(curve.y)}};
    };
    const auto json_of_family = [&](const CurveFamily& family) {
        return Json{{"name", family.name},
                    {"unit", family.unit},
                    {"meaning", family.meaning},
                    {"over", family.over},
                    {"over_bins", family.over_bins},
                    {"at", drawn(family.at_time)},
                    {"curves", Json::list(family.curves, json_of_curve)}};
    };
    return {{"completed", curves.completed},
            {"drawn", curves.drawn},
            {"families", Json::list(curves.families, json_of_family)}};
}

Json runs_of(const store::Store& store, const std::string& campaign) {
    return to_json(store.query(
        fmt::format("SELECT start, version, \"commit\", compiler, flags, instruction_path, processor, host, settled "
                    "FROM provenance "
                    "WHERE campaign_id = (SELECT campaign_id FROM campaign WHERE name = '{}') ORDER BY provenance_id",
                    campaign)));
}

/// Texts beside the figures of a response model.
Json page_json(const ModelCases& cases, const ObservableModel& model, const ModelPictures& pictures) {
    Json over = Json::array();
    std::string others;
    for (std::size_t j = 0; pictures.map && j < cases.factors.size(); ++j) {
        const auto& factor = cases.factors[j];
        if (j == pictures.map->across || j == pictures.map->up) continue;
        others += fmt::format("{}{} {}", others.empty() ? "" : ", ", factor.name,
                              factor.is_word() || std::isnan(pictures.middle[j])
                                  ? factor.text(pictures.middle[j])
                                  : quantity_text(pictures.middle[j], factor.unit));
    }
    if (pictures.map) over = std::array{cases.factors[pictures.map->across].name, cases.factors[pictures.map->up].name};
    return {{"observable", model.observable},
            {"says", model_lines(model)},
            {"failed", !cases.failed.empty()},
            {"over", over},
            {"others", others}};
}

/// One response model after the other, or why there is none.
Json models_of(const store::Store& store, const Responses& responses, const PageModels& asked, Drawings& drawings) {
    Json list = Json::array();
    std::vector<std::string> names = asked.of;
    const auto* main = responses.main_observable();
    if (names.empty() && main != nullptr && responses.settled <= asked.unasked_cases) names.push_back(main->name);
    if (names.empty() || responses.settled == 0) return list;
    const auto cases = settled_and_imported_cases(responses);
    if (cases.settings.empty()) return list;
    for (const auto& name : names) {
        const auto found = std::ranges::find(cases.observables, name, &ResponseColumn::name);
        if (found == cases.observables.end()) continue;
        const auto learned = learn(cases, *found);
        if (const auto* model = std::get_if<ObservableModel>(&learned)) {
            FigureSubject subject{store, responses, responses.observable(name)};
            subject.modelled =
                std::make_shared<const Modelled>(cases, model_pictures(cases, *model, admission(store, cases)));
            add_figures(drawings, name, panels_on_page(subject, OnPage::model));
            list.push_back(
                page_json(cases, *model, subject.modelled->pictures)
                    .add("influence", model_influence_page(model_influence_of(responses, subject.response, *model))));
        } else {
            list.push_back({{"observable", name}, {"refused", std::get<stats::Refusal>(learned).sentence}});
        }
    }
    return list;
}

void refuse_unknown_models(const std::vector<std::string>& names, const PageModels& asked) {
    for (const auto& name : asked.of)
        if (!std::ranges::count(names, name))
            throw campaign::input_error(
                "--model", fmt::format("'{}'", name),
                fmt::format("no campaign has values of such a scalar; there are {}", campaign::listed(names)),
                campaign::nearest_word(name, names));
}

/// The main observable, and every other that has a value.
std::vector<const ResponseColumn*> shown_observables(const Responses& responses) {
    std::vector<const ResponseColumn*> shown;
    for (const auto& response : responses.observables)
        if (&response == responses.main_observable() ||
            std::ranges::any_of(response.values, [](double x) { return std::isfinite(x); }))
            shown.push_back(&response);
    return shown;
}

/// Notes of the campaign file, and the number of cases that were computed elsewhere.
std::string notes_of(const store::Store& store, const store::CampaignRecord& record) {
    auto notes = campaign::remarks_in(record.text).notes;
    if (const auto imported = store.imported_cases(record.name); imported > 0)
        notes +=
            fmt::format("{}{} of the cases were computed elsewhere and imported.", notes.empty() ? "" : "\n", imported);
    return notes;
}

/// `measured`: names of scalars; the names of this campaign's scalars are added.
Json campaign_of(const store::Store& store, const store::CampaignRecord& record, std::string_view database,
                 const PageModels& models, std::vector<std::string>& measured) {
    const auto responses = read_responses(store, record);
    const auto scene = find_scene(record.scene);
    const auto observables = shown_observables(responses);
    for (const auto* one : observables)
        if (!std::ranges::count(measured, one->name)) measured.push_back(one->name);
    const auto main = std::ranges::find(observables, responses.main_observable());
    const auto brackets = brackets_of(store, record);
    const auto calibration = campaign::shows_findings(record) ? calibration_report(store, record) : std::nullopt;
    Drawings drawings;
    Json shown = Json::array();
    for (const auto* one : observables) shown.push_back(page_json(store, responses, *one, drawings));
    const auto fitted = models_of(store, responses, models, drawings);
    if (calibration && !observables.empty())
        add_figures(drawings, "", panels_on_page({store, responses, *observables.front()}, OnPage::campaign));
    Json figures = Json::object();
    for (const auto& [response, svg] : drawings) figures.add(response, svg);
    const auto named_count = [](const auto& counted) { return std::array<Json, 2>{counted.first, counted.second}; };
    return Json{{"name", record.name},
                {"database", database},
                {"notes", notes_of(store, record)},
                {"scene", shown_scene(record.scene)},
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
                {"extends_from", responses.design().extends ? campaign::points_of(record) : std::nullopt},
                {"sample", responses.ordered_sample()},
                {"text", record.text},
                {"stopped_at", record.stopped_at},
                {"outcomes", Json::list(count_outcomes(responses), named_count)}}
        .add(cases_of(responses))
        .add({{"factors", factors_of(responses)},
              {"observables", shown},
              {"main", main == observables.end() ? 0 : main - observables.begin()},
              {"brackets",
               brackets ? Json{{"says", brackets_line(*brackets)}}.add(columns_and_rows(brackets_table(*brackets)))
                        : Json()},
              {"models", fitted},
              {"figures", base64(deflated(figures.text()))},
              {"calibration", calibration ? page_of(*calibration) : Json()},
              {"curves", page_json(read_curves(store, responses))},
              {"failures", failures_of(store, responses)},
              {"runs", runs_of(store, record.name)}});
}

void add_campaigns(Json& campaigns, const PageSource& source, const PageModels& models,
                   std::vector<std::string>& measured) {
    for (const auto& record : find_campaigns(*source.store, ""))
        campaigns.push_back(campaign_of(*source.store, record, source.name, models, measured));
}

}  // namespace

Json campaigns_data(const PageSource& source, const PageModels& models) {
    Json campaigns = Json::array();
    std::vector<std::string> measured;
    add_campaigns(campaigns, source, models, measured);
    return campaigns;
}

Json page_data(std::span<const PageSource> sources, const PageModels& models) {
    Json databases = Json::array(), campaigns = Json::array();
    std::vector<std::string> measured;
    for (const auto& source : sources) {
        databases.push_back(source.name);
        add_campaigns(campaigns, source, models, measured);
    }
    refuse_unknown_models(measured, models);
    return {{"databases", databases}, {"campaigns", campaigns}};
}

std::string safe_in_script(const Json& value) {
    const std::string& text = value.text();
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

/// The player's style, each film in a script element of its own, and the player.
std::string film_elements(std::span<const PageFilm> films, std::string_view player) {
    const auto escaped = [](std::string_view text) {
        std::string safe;
        for (const char c : text)
            safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
        return safe;
    };
    std::string text = fmt::format("<style>\n{}</style>\n", page_files().watch_style);
    for (const auto& film : films) {
        text += fmt::format(
            R"(<script type="application/octet-stream;base64" id="watch-{0}" data-film data-campaign="{1}" )"
            R"(data-case="{0}" data-says="{2}">)",
            escaped(film.case_id), escaped(film.campaign), escaped(film.says));
        text += base64(film.bytes);
        text += "</script>\n";
    }
    return text + fmt::format("<script>{}</script>\n", player);
}

}  // namespace

void write_page(std::ostream& out, std::span<const PageSource> sources, std::span<const PageFilm> films,
                const PageModels& models) {
    const auto data = safe_in_script(page_data(sources, models));
    if (films.empty()) {
        write_figures(out, page_files().library, page_files().report, data);
        return;
    }
    const auto player = enclosed(page_files().films);
    write_figures(out, page_files().library, page_files().report, data, film_elements(films, player), player);
}

std::string write_live_page(std::ostream& out, std::string_view data) {
    return write_figures(out, page_files().library, page_files().live, data, "", "", "'self'");
}

}  // namespace grainsweep::report
