// JSON Schemas of campaign and powder files, for an editor that completes and checks while one types.
#pragma once

#include <string>

namespace grainsweep::campaign {

/// JSON Schema (draft 2020-12), generated from the key tables of the reader, the scenes' parameters and the
/// designs' options. It accepts every campaign the reader accepts; what spans several keys (low below high,
/// relevance, a rule and its design) only the reader knows.
[[nodiscard]] std::string campaign_schema(int indentation = 2);
/// The same of a powder file, from its key tables and the parameters of the scenes.
[[nodiscard]] std::string powder_schema(int indentation = 2);

inline constexpr int on_one_line = -1;  ///< indentation

}  // namespace grainsweep::campaign
