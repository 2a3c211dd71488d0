// Pages are skeletons with named places in double braces.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::report {

/// Writes the skeleton with each part in the place of its name; a place without a part stays empty.
void fill(std::ostream& out, std::string_view skeleton,
          const std::vector<std::pair<std::string_view, std::string_view>>& parts);

/// A script whose names are its own.
[[nodiscard]] std::string enclosed(std::string_view script);
/// The sources that a content security policy names for scripts, each the text of one script element, from tag to tag.
[[nodiscard]] std::string script_sources(const std::vector<std::string_view>& scripts);

}  // namespace grainsweep::report
