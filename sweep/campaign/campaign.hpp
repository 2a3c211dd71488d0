// A campaign: one scene, a space of factors, a design over it, and when to stop.
#pragma once

#include "solver/scenes/scene.hpp"
#include "stats/convergence_rule.hpp"
#include "stats/distribution.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/cases.hpp"
#include "sweep/campaign/formula.hpp"
#include "sweep/designs/design.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

enum class Scale { linear, log };

/// u in [0, 1] -> low + u (high - low), or low (high/low)^u, computed so on every platform.
struct Between {
    double low = 0;
    double high = 1;
    Scale scale = Scale::linear;
    bool operator==(const Between&) const = default;
};

/// u -> level floor(k u), the last one at u = 1.
struct Levels {
    std::vector<Value> values;
    bool operator==(const Levels&) const = default;
};

struct Factor {
    std::string name;
    std::variant<Between, Levels, stats::Distribution> range;
    std::optional<double> step = {};  ///< of a range: its values are multiples of this (step.hpp)
    bool share = false;               ///< of a range: it and the other shares add to one (simplex.hpp)
    std::string group = {};           ///< of factors that move together in saltelli and morris; empty: by itself
    std::string when = {};            ///< SQL condition without which it takes its default; empty: it always counts
    bool operator==(const Factor&) const = default;
};

/// Decides whether a candidate point belongs to the campaign: the `where` clause; or whether a factor counts: `when`.
using Filter = std::function<bool(const Inputs&)>;

/// The compiled `when` of a factor.
struct WhenClause {
    std::string factor;
    Filter holds;  ///< reads inputs in which the clauses before it have been applied
};

/// The group of shares that add to one.
inline constexpr std::string_view group_of_shares = "simplex";
/// Numbers of the groups that factors move in, from 0 in the order of their first factors: those with one name, all
/// shares, every other factor by itself.
[[nodiscard]] std::vector<std::size_t> groups_of(std::span<const Factor> factors);
/// Names of these groups; of a factor by itself its own.
[[nodiscard]] std::vector<std::string> group_names(std::span<const Factor> factors);

/// Whether repeated cases have different probabilities, so that each has the weight of its points in the moments: true
/// with a `when`, a sample, or steps of a range that is not linear. Elsewhere all are equally likely,
/// and each counts once.
[[nodiscard]] bool repeats_weigh(std::span<const Factor> factors);

/// Its value at the coordinate u in [0, 1], not yet in the type of its parameter.
[[nodiscard]] Value value_at(const Factor& factor, double u);
/// The value of factor j at a point of all factors: columns of one sample are drawn together (joint_column.hpp).
[[nodiscard]] Value value_at(std::span<const Factor> factors, std::size_t j, std::span<const double> u);

/// What a parameter is where its factor does not count.
[[nodiscard]] const Value& default_of(const SceneInfo& scene, std::string_view parameter);

/// A fixed parameter whose number follows from others.
struct Expression {
    std::string name;
    Formula formula;
    bool whole = false;  ///< the parameter is a whole number
};

/// What a campaign varies and what it holds.
struct ParameterSpace {
    const SceneInfo* scene = nullptr;
    std::vector<Factor> factors;  ///< their order fixes the design's dimensions
    Inputs fixed;                 ///< as given, with the accuracy setting resolved under it
    /// Held too, as expressions; each stands after those it needs. Their results are unchecked here: expressions.hpp.
    std::vector<Expression> expressions = {};
    /// One for each factor with a `when`, each after those it depends on; compiled by store::compile_conditions.
    std::vector<WhenClause> when = {};

    /// Complete inputs of the point u in [0, 1]^d: defaults, then fixed, factors, defaults again of those whose `when`
    /// does not hold, expressions.
    [[nodiscard]] Inputs at(std::span<const double> u) const;
    /// Complete inputs of a listed row of factor values.
    [[nodiscard]] Inputs at(std::span<const Value> row) const;
};

struct Convergence {
    std::string observable;
    std::string rule = "replicates";  ///< one of stats::convergence_rules
    std::vector<std::string> gates = {"mean", "sd", "kurtosis", "g1"};
    double tolerance = 0.01;
    std::int64_t block = 400;  ///< points between two checks
    bool stop = true;
    bool operator==(const Convergence&) const = default;

    /// Throws std::invalid_argument for a rule that this program does not know.
    [[nodiscard]] const stats::RuleInfo& traits() const;
};

/// Checks that a campaign is divided into where it does not give a block, and the longest such block.
inline constexpr std::int64_t checks_by_default = 8, longest_default_block = 400;
/// Points between two checks where a campaign does not say: an eighth of its design at most, a multiple of its
/// independent sequences, 400 at most and no less than `least`.
[[nodiscard]] std::int64_t default_block(std::int64_t points, std::int64_t sequences, std::int64_t least);
/// Fewest points of a block: 4, and under a rule that compares sequences 4 for each.
[[nodiscard]] std::int64_t least_block(const stats::RuleInfo& rule, std::int64_t sequences);

struct Limits {
    std::optional<double> wall_seconds;  ///< per attempt
    std::int64_t attempts = 3;
};

struct Execution {
    std::optional<std::int64_t> workers;           ///< otherwise all cores
    std::vector<std::string> launcher;             ///< argv prefix of a worker, or of a host
    std::optional<std::int64_t> hosts;             ///< processes that run workers on a node of their own
    std::optional<std::int64_t> workers_per_host;  ///< otherwise one per processor of this machine
    std::optional<std::int64_t> threads;           ///< of a case; otherwise those that no other case needs
    std::optional<double> walltime;                ///< seconds that the main program may take
    std::optional<double> start_seconds = 300;     ///< a worker that is not ready by then is replaced
    std::optional<double> silence_seconds = 60;    ///< so is one that says nothing for so long while it has a case
};

/// A file that a campaign uses, to be kept with it.
struct CampaignFile {
    std::string place;           ///< where the campaign file names it: "$.fixed.size_file"
    std::string name;            ///< as it is named there
    std::string hash;            ///< of its contents
    std::filesystem::path path;  ///< empty: the program made it, and its contents are known
};

struct Campaign {
    std::string name;
    ParameterSpace space;
    std::string where;  ///< empty: every point
    std::string design;
    designs::DesignRequest request;
    std::int64_t replicates = 1;
    std::uint64_t seed = 1;
    /// Inputs that change no seed: cases that differ in these alone draw the same random numbers (common random
    /// numbers).
    std::vector<std::string> common_random_numbers;
    std::optional<Convergence> convergence;
    std::string accuracy;  ///< empty: none asked
    /// Of response models: expressions over the factors; empty: the factors, or their logarithms. No part of what the
    /// campaign is.
    std::vector<std::string> features;
    Limits limits;
    Execution execution;
    std::string text;    ///< the campaign file as read
    std::string powder;  ///< what its powder file sets, in a sentence; empty: it names none
    std::vector<CampaignFile> files;

    [[nodiscard]] const SceneInfo& scene() const { return *space.scene; }
};

/// Brings the factors, and the design's options that are given factor by factor, into `order`. Returns whether that
/// changed anything; where `order` does not name exactly these factors nothing is changed.
bool reorder_factors(Campaign& campaign, std::span<const std::string> order);
/// "a, b, c".
[[nodiscard]] std::string factor_list(const ParameterSpace& space);
/// Number of points of the design, including points that `where` leaves out. Throws std::invalid_argument where
/// options of the design are impossible together.
[[nodiscard]] std::int64_t candidates_of(const Campaign& campaign);
/// Why the campaign can never be found to have converged, however its answers turn out; empty: it can, or it gives no
/// rule.
[[nodiscard]] std::string never_converges(const Campaign& campaign);

/// The names a `where` clause may use: every parameter of the scene.
[[nodiscard]] std::vector<std::string> filter_names(const Campaign& campaign);

/// More than this is a slip of the keyboard, and would not fit into memory.
inline constexpr std::int64_t most_cases = 1'000'000;

/// A case for every point and replicate that passes the filter, ordered by point, then replicate. Point numbers keep
/// the gaps of what was filtered out. Later changes of `campaign` do not reach the cases. Throws WrongQuestion when the
/// design's options are impossible together, when no point is left and when there are more than most_cases.
[[nodiscard]] Cases unfold(const Campaign& campaign, const Filter& filter);
/// Throws WrongQuestion where unfold would for the design.
void check_design(const Campaign& campaign);

/// A case from inputs (defaults filled in, types coerced): its id is the hash of its canonical text.
/// Throws WrongQuestion for a parameter the scene has not.
[[nodiscard]] Case make_case(const SceneInfo& scene, const Inputs& inputs, std::uint64_t seed);

/// Returns the seed of the campaign's case with these inputs. It depends on the arguments and on nothing else.
[[nodiscard]] std::uint64_t case_seed(const Campaign& campaign, const Inputs& inputs, std::int64_t replicate);

/// A value in the type of `like`: a whole number as a real one and back where it is exact, -0 as 0.
[[nodiscard]] Value coerced(const Value& value, const Value& like);

}  // namespace grainsweep::campaign
