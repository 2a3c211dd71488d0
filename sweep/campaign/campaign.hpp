// Campaign: one scene, a space of factors, a design in this space, and limits.
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

using designs::Between;
using designs::Factor;
using designs::Levels;
using designs::Scale;

/// Filter: whether a candidate point belongs to the campaign (`where`), or whether a factor counts (`when`).
using Filter = std::function<bool(const Inputs&)>;

/// Compiled `when` of a factor.
struct WhenClause {
    std::string factor;
    Filter holds;  ///< reads inputs to which earlier clauses have been applied
};

/// Name of the group of shares that add to one.
inline constexpr std::string_view group_of_shares = "simplex";
/// Returns the number of each factor's group, from 0 in the order of the groups' first factors. Groups are the factors
/// with one group name, all shares together, and every other factor by itself.
[[nodiscard]] std::vector<std::size_t> groups_of(std::span<const Factor> factors);
/// Returns the names of these groups; a single factor has its own name.
[[nodiscard]] std::vector<std::string> group_names(std::span<const Factor> factors);

/// Returns whether repeated cases have different probabilities, so that each is weighted by its points in the moments.
/// True with a `when`, a sample, or steps of a nonlinear range. Otherwise all cases are equally likely and count once.
[[nodiscard]] bool repeats_weigh(std::span<const Factor> factors);

/// Returns the value of factor j at a point of all factors; columns of one sample are chosen together
/// (joint_column.hpp).
[[nodiscard]] Value value_at(std::span<const Factor> factors, std::size_t j, std::span<const double> u);

/// Returns the value of a parameter whose factor does not count.
[[nodiscard]] const Value& default_of(const SceneInfo& scene, std::string_view parameter);

/// Fixed parameter that is computed from other parameters.
struct Expression {
    std::string name;
    Formula formula;
    bool whole = false;  ///< the parameter is a whole number
};

/// Varied and fixed parameters of a campaign.
struct ParameterSpace {
    SharedScene scene;
    std::vector<Factor> factors;  ///< their order fixes the design's dimensions
    Inputs fixed;                 ///< as given, with the inputs of the accuracy setting
    /// Fixed parameters given as expressions, each after the ones that it needs. expressions.hpp checks their results.
    std::vector<Expression> expressions = {};
    /// One for each factor with a `when`, each after the ones on which it depends; compiled by
    /// store::compile_conditions.
    std::vector<WhenClause> when = {};

    /// Returns the complete inputs of the point u in [0, 1]^d: first defaults, then fixed values, factors, defaults
    /// where a `when` is false, and expressions.
    [[nodiscard]] Inputs at(std::span<const double> u) const;
    /// Returns the complete inputs of a listed row of factor values.
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

    /// Returns the traits of the rule. Throws std::invalid_argument for an unknown rule.
    [[nodiscard]] const stats::RuleInfo& traits() const;
};

/// Number of checks of a campaign without a block, and the longest default block.
inline constexpr std::int64_t checks_by_default = 8, longest_default_block = 400;
/// Returns the default points between two checks: at most an eighth of the design, a multiple of the independent
/// sequences, at most 400 and at least `least`.
[[nodiscard]] std::int64_t default_block(std::int64_t points, std::int64_t sequences, std::int64_t least);
/// Returns the fewest points of a block: 4, or 4 per sequence for a rule that compares sequences.
[[nodiscard]] std::int64_t least_block(const stats::RuleInfo& rule, std::int64_t sequences);

struct Limits {
    std::optional<double> wall_seconds;  ///< per attempt
    std::int64_t attempts = 3;
};

struct Execution {
    std::optional<std::int64_t> workers;           ///< empty: all cores
    std::vector<std::string> launcher;             ///< argv prefix of a worker, or of a host
    std::optional<std::int64_t> hosts;             ///< processes that run the workers of one node each
    std::optional<std::int64_t> workers_per_host;  ///< empty: one per processor of this machine
    std::optional<std::int64_t> threads;           ///< of a case; empty: idle cores are used, too
    std::optional<double> walltime;                ///< time limit of the main program, s
    std::optional<double> start_seconds = 300;     ///< a worker that is not ready after this time is replaced
    std::optional<double> silence_seconds = 60;    ///< a worker with a case that is silent for this time is replaced
};

/// File that a campaign uses, stored with the campaign.
struct CampaignFile {
    std::string place;           ///< path in the campaign file: "$.fixed.size_file"
    std::string name;            ///< name in the campaign file
    std::string hash;            ///< of its contents
    std::filesystem::path path;  ///< empty: the program made the file and has its contents
};

struct Campaign {
    std::string name;
    ParameterSpace space;
    std::string where;  ///< empty: every point
    std::string design;
    designs::DesignRequest request;
    std::int64_t replicates = 1;
    std::uint64_t seed = 1;
    /// Inputs that do not change the seed: cases that differ in these inputs alone use the same random numbers (common
    /// random numbers).
    std::vector<std::string> common_random_numbers;
    std::optional<Convergence> convergence;
    std::string accuracy;  ///< empty: none
    /// Features of response models, as expressions of the factors; empty: the factors, or their logarithms. No part of
    /// the campaign's identity.
    std::vector<std::string> features;
    Limits limits;
    Execution execution;
    std::string text;          ///< text of the campaign file
    std::string powder;        ///< parameters set by its powder file, in a sentence; empty: no powder file
    std::string powder_lacks;  ///< warning: sizes or density that the powder file lacks; empty: none
    std::vector<CampaignFile> files;

    [[nodiscard]] const SceneInfo& scene() const { return *space.scene; }
};

/// Sorts the factors, and the design's options with one value per factor, into `order`. Returns whether the order
/// changed. Does nothing if `order` does not name exactly these factors.
bool reorder_factors(Campaign& campaign, std::span<const std::string> order);
/// Returns the names as "a, b, c".
[[nodiscard]] std::string factor_list(const ParameterSpace& space);
/// Returns the number of points of the design, including points that `where` excludes. Throws std::invalid_argument if
/// the combination of the design's options is impossible.
[[nodiscard]] std::int64_t candidates_of(const Campaign& campaign);
/// Returns why the campaign cannot converge for any answers; empty: it can, or it has no rule.
[[nodiscard]] std::string never_converges(const Campaign& campaign);

/// Returns the names that a `where` clause may use: every parameter of the scene.
[[nodiscard]] std::vector<std::string> filter_names(const Campaign& campaign);

/// Largest number of cases; more are a typing error and would not fit into memory.
inline constexpr std::int64_t most_cases = 1'000'000;

/// Returns a case for every admitted point and replicate, ordered by point, then replicate. Numbers of excluded points
/// are not reused. Later changes of `campaign` do not affect the cases. Throws InputError if the combination of the
/// design's options is impossible, no point is left, or there are more than most_cases.
[[nodiscard]] Cases unfold(const Campaign& campaign, const Filter& filter);
/// Throws InputError like unfold() for an impossible design.
void check_design(const Campaign& campaign);

/// Returns a case from inputs (with defaults and converted types); its id is the hash of its canonical text. Throws
/// InputError for an unknown parameter.
[[nodiscard]] Case make_case(const SceneInfo& scene, const Inputs& inputs, std::uint64_t seed);

/// Returns the seed of the campaign's case with these inputs. It depends only on the arguments.
[[nodiscard]] std::uint64_t case_seed(const Campaign& campaign, const Inputs& inputs, std::int64_t replicate);

/// Returns a value in the type of `like`: a whole number as a real one and back if this is exact, -0 as 0.
[[nodiscard]] Value coerced(const Value& value, const Value& like);

}  // namespace grainsweep::campaign
