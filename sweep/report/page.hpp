// Report page of whole databases: data, figures and their scripts in one file that needs no network.
#pragma once

#include "sweep/report/table.hpp"

#include <cstddef>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// Most failed cases that are listed.
inline constexpr std::size_t most_listed_failures = 200;

/// Database of the page.
struct PageSource {
    const store::Store* store = nullptr;
    std::string name;  ///< its name on the page
};

/// Response models of the page, campaign by campaign.
struct PageModels {
    /// Observables of the models; a campaign without one is skipped.
    std::vector<std::string> of = {};
    /// Most settled cases of a campaign for which, without names, the model of the main observable is shown (a model of
    /// 1,000 cases takes some seconds).
    std::size_t unasked_cases = 1000;
};

/// Film of a case in the page.
struct PageFilm {
    std::string campaign, case_id;
    std::string says;   ///< reason of the choice, in a few words
    std::string bytes;  ///< Film::bytes
};

/// Returns figures and all cases of every campaign of the databases for the script of the page. Columns of numbers are
/// packed (packed_column.hpp).
[[nodiscard]] Json page_data(std::span<const PageSource> sources, const PageModels& models = {});

/// Returns the list "campaigns" of page_data of one database.
[[nodiscard]] Json campaigns_data(const PageSource& source, const PageModels& models = {});

/// Returns JSON that is safe inside a script element: without "</", "<!--" and the line separators of JavaScript.
[[nodiscard]] std::string safe_in_script(const Json& value);

/// Writes the page with all campaigns of all databases; the reader can overlay any two. Bytes that are no UTF-8 are
/// replaced.
void write_page(std::ostream& out, std::span<const PageSource> sources, std::span<const PageFilm> films = {},
                const PageModels& models = {});

/// Writes the page of `serve`, whose data grows, beginning with `data` (an object, safe in a script). Returns its
/// content security policy.
[[nodiscard]] std::string write_live_page(std::ostream& out, std::string_view data);

}  // namespace grainsweep::report
