#include "sweep/report/page_template.hpp"

#include <algorithm>
#include <ostream>

namespace grainsweep::report {

void fill(std::ostream& out, std::string_view skeleton,
          const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
    while (true) {
        const auto open = skeleton.find("{{");
        const auto close = skeleton.find("}}", open == std::string_view::npos ? 0 : open);
        if (open == std::string_view::npos || close == std::string_view::npos) break;
        out << skeleton.substr(0, open);
        const auto name = skeleton.substr(open + 2, close - open - 2);
        const auto part = std::ranges::find(parts, name, &std::pair<std::string_view, std::string_view>::first);
        if (part != parts.end()) out << part->second;
        skeleton.remove_prefix(close + 2);
    }
    out << skeleton;
}

}  // namespace grainsweep::report
