// What makes a campaign the same campaign: its scene, factors, fixed values, condition, seed and kind of design. An
// archive keeps it as it stands here and decides nothing by it.
//
// More points or replicates extend a campaign, where the design extends; of a design that does not, another size is
// another design. Levels that a factor of a lattice gains renumber the points: the new placement replaces the old one.
// Cases are known by what they ask, so every answer is kept and shared.
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
    /// One line each, in order: "name between low high scale", behind it "step 0.5" or "share", "name levels a | b |
    /// ..." or name and distribution (stated_distribution.hpp); then lines " group name its_group" and " when name
    /// condition", which begin with a blank.
    std::string factors;
    std::string fixed;      ///< one line each: "name = value", the accuracy setting resolved
    std::string condition;  ///< the `where` clause; empty: every point
    std::string design;
    std::string options;  ///< one line each, "name = value": those that say which design it is
    std::string extent;   ///< those that say how much of it is asked
};

[[nodiscard]] Identity identity_of(const Campaign& campaign);
/// Throws WrongQuestion, naming both, where `asked` is another campaign than the one that stands in `archive` under its
/// name.
void require_same(const Identity& stored, const Identity& asked, std::string_view archive);

/// A factor as it stands in an identity: a range, a distribution, or levels as `identity_text` writes them (a file by
/// its contents).
struct StatedFactor {
    std::string name;
    std::optional<Between> between;
    std::vector<std::string> levels;  ///< in the order of the campaign file; empty where there is a range
    std::optional<stats::Distribution> distribution = {};
    std::optional<double> step = {};
    bool share = false;
    std::string group = {}, when = {};
    bool operator==(const StatedFactor&) const = default;
    [[nodiscard]] bool continuous() const { return between || distribution; }
};
/// The factors in the order that fixes the dimensions of the design.
[[nodiscard]] std::vector<StatedFactor> factors_of(const Identity& identity);
/// The factors as an identity states them, in one line; and back.
[[nodiscard]] std::string factors_line(const std::vector<Factor>& factors);
[[nodiscard]] std::vector<StatedFactor> factors_in(std::string_view line);
/// Their names.
[[nodiscard]] std::vector<std::string> factor_names(const Identity& identity);
/// Every option of the design, as text.
[[nodiscard]] std::map<std::string, std::string, std::less<>> options_in(const Identity& identity);
/// Points that the design was asked for at most; none where it is not asked for points.
[[nodiscard]] std::optional<std::int64_t> points_of(const Identity& identity);
/// Equal for campaigns that ask the same of a scene and differ in name, seed and how much of the design they ask for
/// alone.
[[nodiscard]] std::string family_of(const Identity& identity);
/// "halton: points = 2400, scramble = random, sequences = 8".
[[nodiscard]] std::string design_line(const Identity& identity);
/// "friction = 0.2, restitution = 0.5"; empty: every parameter not varied has its default.
[[nodiscard]] std::string fixed_line(const Identity& identity);
/// The larger of two extents of one design that extends, option by option; of any other the later one.
[[nodiscard]] std::string larger_extent(std::string_view design, const std::string& before, const std::string& after);
/// Sequences of the design: point p belongs to sequence p mod this.
[[nodiscard]] std::int64_t sequences_of(const Campaign& campaign);

}  // namespace grainsweep::campaign
