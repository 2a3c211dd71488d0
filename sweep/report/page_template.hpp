// Pages from skeletons with named placeholders in double braces.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::report {

/// Writes the skeleton with each placeholder replaced by its part, or by nothing if there is none.
void fill(std::ostream& out, std::string_view skeleton,
          const std::vector<std::pair<std::string_view, std::string_view>>& parts);

/// Writes a page of figures: library and script, its data (safe_in_script), and the elements of films with their
/// script. `asks`: sources to which the script may connect, "'self'" for its server; empty: none. Returns the content
/// security policy of the page.
std::string write_figures(std::ostream& out, std::string_view library, std::string_view script, std::string_view data,
                          std::string_view films = "", std::string_view film_script = "", std::string_view asks = "");

/// Encloses a script in a function, so that it defines no global names.
[[nodiscard]] std::string enclosed(std::string_view script);
/// Returns the sources for a content security policy, one for the text of each script element from tag to tag.
[[nodiscard]] std::string script_sources(const std::vector<std::string_view>& scripts);

}  // namespace grainsweep::report
