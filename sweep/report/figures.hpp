// Figures of the report for print: the data of sweep/study as panels with axes.
//
// "NAME" draws a whole figure, "NAME:PANEL" one of its panels (for example, one factor).
#pragma once

#include "sweep/plot/plot.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/responses.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::report {

struct Modelled;

/// Subject of a figure: one response of one campaign.
struct FigureSubject {
    const store::Store& store;
    const study::Responses& responses;
    const study::ResponseColumn& response;
    /// Names of variables, for figures with such options; empty: the response and the two most influential factors.
    std::string across = {}, up = {}, colour = {};
    /// Whether the axis of the response is logarithmic; empty: where what a figure shows of it spans decades.
    std::optional<bool> log = {};
    /// Whether the axis of `across` is logarithmic; empty: as its factor is divided.
    std::optional<bool> across_log = {};
    bool lines = false;  ///< means over `across` with their errors, joined: a line per level of `colour`
    // What the caller has computed already; nullptr: computed for each figure.
    const study::History* history = nullptr;
    const study::Influence* influence = nullptr;
    std::shared_ptr<const Modelled> modelled = {};
};

struct FigureInfo {
    std::string name, shows;
    std::vector<std::string> panels;  ///< empty: the figure has only one panel
};
/// Returns the figures for which this campaign has data.
[[nodiscard]] std::vector<FigureInfo> figures_for(const FigureSubject& subject);

/// What the figures of a page belong to. Of the others, in which readers act, its script draws its own.
enum class OnPage { campaign, response, model, script };
/// Figures of one panel each, with names such as "effects:friction".
using NamedFigures = std::vector<std::pair<std::string, plot::Figure>>;
/// Returns the panels for which this campaign has data, each as figure_named() returns it.
[[nodiscard]] NamedFigures panels_on_page(const FigureSubject& subject, OnPage place);

/// Returns the figure of a name such as "effects" or "effects:friction". Throws InputError for a name that is not in
/// figures_for(), with the nearest one; for a refused model; and for an option that the figure does not have.
[[nodiscard]] plot::Figure figure_named(const FigureSubject& subject, std::string_view name);

}  // namespace grainsweep::report
