#include "sweep/report/page_template.hpp"

#include "sweep/report/packed_column.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/sha256.hpp"

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

std::string write_figures(std::ostream& out, std::string_view script, std::string_view data, std::string_view films,
                          std::string_view film_script, std::string_view asks) {
    const auto files = page_files();
    const auto program = enclosed(script);
    std::vector<std::string_view> scripts = {files.library, program};
    if (!film_script.empty()) scripts.push_back(film_script);
    const std::string policy = "default-src 'none'; style-src 'unsafe-inline'; script-src " + script_sources(scripts) +
                               "; img-src data:" + (asks.empty() ? "" : "; connect-src " + std::string(asks));
    fill(out, files.skeleton,
         {{"policy", policy},
          {"style", files.style},
          {"library", files.library},
          {"films", films},
          {"data", data},
          {"program", program}});
    return policy;
}

std::string enclosed(std::string_view script) {
    return "(function () {\n\"use strict\";\n" + std::string(script) + "\n})();\n";
}

std::string script_sources(const std::vector<std::string_view>& scripts) {
    std::string sources;
    for (const auto script : scripts) {
        const auto digest = sha256(script);
        sources +=
            (sources.empty() ? "'sha256-" : " 'sha256-") + base64(std::string(digest.begin(), digest.end())) + "'";
    }
    return sources;
}

}  // namespace grainsweep::report
