// Identity of a campaign in the database, and the design request and parameter space that follow from it. Stored is a
// campaign file with resolved values (JSON), and the texts beside it, which are all that a database before schema 12
// has.
//
// The JSON has the keys of a campaign file, and "revision" of the scene. Its numbers are in SI units. "fixed" has the
// accuracy setting and the powder resolved. A sample is one column: {"of": hash of all its columns, "column": from 0,
// "values": [...]}.
//
// The texts: one line per factor, in order, "name between low high scale", with "step 0.5" or "share" behind it; "name
// levels a | b | ..."; or name and distribution (stated_distribution.hpp). Then lines " group name its_group" and
// " when name condition", which begin with a blank. Fixed values and options are lines "name = value".
#pragma once

#include "sweep/campaign/identity.hpp"
#include "sweep/designs/design.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

[[nodiscard]] std::string resolved_text(const Identity& identity);
/// Reads a text of resolved_text().
[[nodiscard]] Identity read_resolved(std::string_view text);

struct IdentityTexts {
    std::string factors, fixed;
    std::string options, extent;  ///< options that identify the design, and those for its extent
};
[[nodiscard]] IdentityTexts texts_of(const Identity& identity);
/// Reads texts into an identity that has scene and design. If this program does not have the scene, a fixed value is a
/// text.
void read_texts(Identity& identity, const IdentityTexts& texts);

/// Convert factors to one line of their texts and back.
[[nodiscard]] std::string factors_line(const std::vector<Factor>& factors);
[[nodiscard]] std::vector<Factor> factors_in(std::string_view line);

/// Returns an option as in the texts.
[[nodiscard]] std::string text_of(const designs::OptionValue& value);
[[nodiscard]] std::vector<std::string> text_lines(const std::string& text);

/// Returns options, levels and ranges; listed rows are not included, because they are in the places of the campaign.
/// Throws std::logic_error for an unknown design.
[[nodiscard]] designs::DesignRequest request_of(const Identity& identity);
/// Returns the fixed values of the scene's parameters, without expressions.
[[nodiscard]] Inputs fixed_values(const Identity& identity, const SceneInfo& scene);
/// Returns the parameter space of a stored campaign, without compiled `when` clauses; empty for an unknown scene.
[[nodiscard]] std::optional<ParameterSpace> space_of(const Identity& identity);

}  // namespace grainsweep::campaign
