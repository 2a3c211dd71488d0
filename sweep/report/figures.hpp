// The figures of the report for print: the same data from sweep/study, as panels with axes.
//
// A figure of several panels (one per factor, say) is drawn whole by its name, and one panel of it by "NAME:PANEL".
#pragma once

#include "sweep/plot/plot.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/responses.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

/// What is drawn: one response of one campaign.
struct FigureSubject {
    const store::Store& store;
    const study::Responses& responses;
    const study::ResponseColumn& response;
    /// Of the figures that have a choice, names of variables; empty: the response over the two most influential
    /// factors.
    std::string across = {}, up = {}, colour = {};
};

struct FigureInfo {
    std::string name, shows;
    std::vector<std::string> panels;  ///< empty: the figure is one panel
};
/// Figures that this campaign has data for.
[[nodiscard]] std::vector<FigureInfo> figures_for(const FigureSubject& subject);

/// "effects", or "effects:friction". Throws WrongQuestion for a name that figures_for() does not have, with the nearest
/// one; for a model that is refused; and for a choice that the figure does not have.
[[nodiscard]] plot::Figure figure_named(const FigureSubject& subject, std::string_view name);

}  // namespace grainsweep::report
