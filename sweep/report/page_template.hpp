// Pages are skeletons with named places in double braces.
#pragma once

#include <iosfwd>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::report {

/// Writes the skeleton with each part in the place of its name; a place without a part stays empty.
void fill(std::ostream& out, std::string_view skeleton,
          const std::vector<std::pair<std::string_view, std::string_view>>& parts);

}  // namespace grainsweep::report
