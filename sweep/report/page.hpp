// One page that holds a whole database: figures, pictures and the program that draws them, in one file that needs no
// network.
#pragma once

#include "sweep/report/table.hpp"

#include <cstddef>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// Failed cases that are listed one by one.
inline constexpr std::size_t most_listed_failures = 200;

/// A database of the page.
struct PageSource {
    const store::Store* store = nullptr;
    std::string name;  ///< what the page calls it
};

/// Which response models the page shows, campaign by campaign.
struct PageModels {
    /// Their observables; a campaign that lacks one is passed over.
    std::vector<std::string> of = {};
    /// Without a name: that of the main observable, of campaigns of at most so many settled cases (a model of 1,000
    /// cases takes some seconds).
    std::size_t unasked_cases = 1000;
};

/// A film in the page, of a case that it shows.
struct PageFilm {
    std::string campaign, case_id;
    std::string says;   ///< why it was chosen, in a few words
    std::string bytes;  ///< Film::bytes
};

/// The figures and all cases of every campaign of the databases, as the page's program reads them. Columns of numbers
/// are packed (packed_column.hpp).
[[nodiscard]] Json page_data(std::span<const PageSource> sources, const PageModels& models = {});

/// JSON that may stand inside a script element: "</", "<!--" and the line separators of JavaScript cannot occur.
[[nodiscard]] std::string safe_in_script(const Json& value);

/// Writes the page: all campaigns of all databases; any two can be laid over one another. Bytes of a database
/// that are no UTF-8 are replaced.
void write_page(std::ostream& out, std::span<const PageSource> sources, std::span<const PageFilm> films = {},
                const PageModels& models = {});

/// Writes the page of `serve`: the same whose data grows, beginning with this (an object, safe in a script). Returns
/// its content security policy.
[[nodiscard]] std::string write_live_page(std::ostream& out, std::string_view data);

}  // namespace grainsweep::report
