// Identity of a campaign: scene, factors, fixed values, condition, seed and kind of design.
//
// More points or replicates extend a campaign if the design is extensible; otherwise another size is another design.
// New levels of a factor of a lattice renumber the points: the new placement replaces the old one. Cases are identified
// by their inputs, so every answer is kept and shared.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Words that name files are those of identity_text(): by the contents.
struct Identity {
    std::string name, scene;
    std::int64_t revision = 1;
    std::uint64_t seed = 1;
    std::vector<Factor> factors = {};  ///< in the order of the design's dimensions
    Inputs fixed = {};           ///< as in the campaign file, the accuracy setting resolved; expressions as their text
    std::string condition = {};  ///< the `where` clause; empty: every point
    std::string design = {};
    decltype(designs::DesignRequest::options) options = {};  ///< of the design, without listed rows
    std::vector<std::string> common_random_numbers = {};
};

[[nodiscard]] Identity identity_of(const Campaign& campaign);
/// Throws InputError with both identities if `asked` differs from the campaign of the same name in `archive`.
void require_same(const Identity& stored, const Identity& asked, std::string_view archive);
/// Returns whether two campaigns differ in their points alone: the same scene, factors and fixed values.
[[nodiscard]] bool asks_the_same(const Identity& a, const Identity& b);

/// Returns an option of the design that is a word; null: it has none.
[[nodiscard]] const std::string* word_of(const Identity& identity, std::string_view option);
/// Returns the largest requested number of points; empty for a design without points.
[[nodiscard]] std::optional<std::int64_t> points_of(const Identity& identity);
/// Returns a text that is equal for campaigns that differ only in name, seed and extent of the design.
[[nodiscard]] std::string family_of(const Identity& identity);
/// Returns a line such as "halton: points = 2400, scramble = random, sequences = 8".
[[nodiscard]] std::string design_line(const Identity& identity);
/// Returns a line such as "friction = 0.2, restitution = 0.5"; empty: every parameter that is not varied has its
/// default.
[[nodiscard]] std::string fixed_line(const Identity& identity);
/// Keeps the larger of two extents of an extensible design, option by option; of any other design the later one.
void keep_extent(Identity& later, const Identity& earlier);
/// Returns the number of sequences of the design: point p belongs to sequence p mod this number.
[[nodiscard]] std::int64_t sequences_of(const Campaign& campaign);

}  // namespace grainsweep::campaign
