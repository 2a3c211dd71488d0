// Identity of a campaign: scene, factors, fixed values, condition, seed and kind of design. The database stores it
// without interpreting it.
//
// More points or replicates extend a campaign if the design is extensible; otherwise another size is another design.
// New levels of a factor of a lattice renumber the points: the new placement replaces the old one. Cases are identified
// by their inputs, so every answer is kept and shared.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

struct Identity {
    std::string name, scene;
    std::int64_t revision = 1;
    std::uint64_t seed = 1;
    /// One line per factor, in order: "name between low high scale", with "step 0.5" or "share" behind it; "name levels
    /// a | b | ..."; or name and distribution (stated_distribution.hpp). Then lines " group name its_group" and " when
    /// name condition", which begin with a blank.
    std::string factors;
    std::string fixed;      ///< one line each: "name = value", the accuracy setting resolved
    std::string condition;  ///< the `where` clause; empty: every point
    std::string design;
    std::string options;  ///< one line each, "name = value": options that identify the design
    std::string extent;   ///< options for the extent of the design
};

[[nodiscard]] Identity identity_of(const Campaign& campaign);
/// Throws InputError with both identities if `asked` differs from the campaign of the same name in `archive`.
void require_same(const Identity& stored, const Identity& asked, std::string_view archive);

/// Factor of an identity: a range, a distribution, or levels as `identity_text` writes them (a file by its contents).
struct StatedFactor {
    std::string name;
    std::optional<Between> between;
    std::vector<std::string> levels;  ///< in the order of the campaign file; empty for a range
    std::optional<stats::Distribution> distribution = {};
    std::optional<double> step = {};
    bool share = false;
    std::string group = {}, when = {};
    bool operator==(const StatedFactor&) const = default;
    [[nodiscard]] bool continuous() const { return between || distribution; }
};
/// Returns the factors in the order of the design's dimensions.
[[nodiscard]] std::vector<StatedFactor> factors_of(const Identity& identity);
/// Convert the factors to the text of an identity and back.
[[nodiscard]] std::string factors_line(const std::vector<Factor>& factors);
[[nodiscard]] std::vector<StatedFactor> factors_in(std::string_view line);
/// Returns the names of the factors.
[[nodiscard]] std::vector<std::string> factor_names(const Identity& identity);
/// Returns every option of the design, as text.
[[nodiscard]] std::map<std::string, std::string, std::less<>> options_in(const Identity& identity);
/// Returns the largest requested number of points; empty for a design without points.
[[nodiscard]] std::optional<std::int64_t> points_of(const Identity& identity);
/// Returns a text that is equal for campaigns that differ only in name, seed and extent of the design.
[[nodiscard]] std::string family_of(const Identity& identity);
/// Returns a line such as "halton: points = 2400, scramble = random, sequences = 8".
[[nodiscard]] std::string design_line(const Identity& identity);
/// Returns a line such as "friction = 0.2, restitution = 0.5"; empty: every parameter that is not varied has its
/// default.
[[nodiscard]] std::string fixed_line(const Identity& identity);
/// Returns the larger of two extents of an extensible design, option by option; of any other design the later one.
[[nodiscard]] std::string larger_extent(std::string_view design, const std::string& before, const std::string& after);
/// Returns the number of sequences of the design: point p belongs to sequence p mod this number.
[[nodiscard]] std::int64_t sequences_of(const Campaign& campaign);

}  // namespace grainsweep::campaign
