// JSON Schemas of the files that users write, for completion and checks in editors.
#pragma once

#include <string>

namespace grainsweep::campaign {

/// Returns the JSON Schema (draft 2020-12), generated from the key tables of the reader, the scenes' parameters and the
/// designs' options. It accepts every campaign that the reader accepts. Only the reader checks relations between keys
/// (low below high, relevance, a rule and its design).
[[nodiscard]] std::string campaign_schema(int indentation = 2);
/// Returns the same for a powder file, from its key tables and the parameters of the scenes.
[[nodiscard]] std::string powder_schema(int indentation = 2);
/// Returns the same for a machine file, from its fields and the options of the probes.
[[nodiscard]] std::string machine_schema(int indentation = 2);
/// Returns the same for the section "program" of a campaign file.
[[nodiscard]] std::string program_schema(int indentation = 2);

inline constexpr int on_one_line = -1;  ///< indentation

}  // namespace grainsweep::campaign
