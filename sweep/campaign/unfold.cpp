#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/simplex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

namespace grainsweep::campaign {

namespace {

/// A distribution without ends has no value at the end of its cube.
void check_ends(const Campaign& campaign, const designs::PointSet& points) {
    const auto& factors = campaign.request.factors;
    if (!points.rows.empty() || std::ranges::none_of(factors, &Factor::endless)) return;
    for (std::size_t p = 0; p < points.size(); ++p)
        for (std::size_t j = 0; j < factors.size(); ++j)
            if (const double u = points.point(p)[j]; factors[j].endless() && (u <= 0 || u >= 1))
                throw input_error(
                    "$.design", campaign.design,
                    fmt::format("its point {} stands at an end of factor '{}', whose distribution has none: give "
                                "\"placement\": \"centred\" to a lattice, \"scramble\": \"random\" to a sequence, or "
                                "\"between\" to the factor",
                                p, factors[j].name));
}

designs::PointSet sample(const Campaign& campaign) {
    const auto* design = designs::find_design(campaign.design);
    if (design == nullptr) throw input_error("$.design.kind", campaign.design, "there is no such design");
    designs::PointSet points;
    try {
        points = design->sample(campaign.request);
        for (std::size_t p = 0; points.rows.empty() && p < points.size(); ++p)
            share_out(campaign.space.factors,
                      std::span(points.coordinates).subspan(p * points.dimensions, points.dimensions));
    } catch (const std::invalid_argument& error) {
        throw input_error("$.design", "", error.what());
    }
    if (points.size() == 0) throw input_error("$.design", "", "the design has no point");
    check_ends(campaign, points);
    if (points.size() > static_cast<std::size_t>(most_cases / campaign.replicates))
        throw input_error("$.design", fmt::format("{} points x {} replicates", points.size(), campaign.replicates),
                          fmt::format("a campaign has at most {} cases", most_cases));
    return points;
}

/// A scene and its defaults, looked up once for many cases.
class CaseMaker {
public:
    explicit CaseMaker(const SceneInfo& scene) : scene_(scene), defaults_(scene.defaults()) {}

    [[nodiscard]] Inputs completed(const Inputs& given) const {
        Inputs inputs = defaults_;
        for (const auto& [name, value] : given) {
            const auto slot = inputs.find(name);
            if (slot == inputs.end()) {
                throw InputError(fmt::format("scene '{}' has no parameter '{}'.", scene_.name, name));
            }
            slot->second = coerced(value, slot->second);
        }
        return inputs;
    }
    [[nodiscard]] std::string text(const Inputs& inputs, std::optional<std::uint64_t> seed) const {
        return canonical_text(scene_.name, scene_.revision, inputs, defaults_, seed);
    }
    [[nodiscard]] Case make(Inputs inputs, std::uint64_t seed) const {
        std::string id = content_hash(text(inputs, seed));
        return {std::move(id), scene_.name, scene_.revision, std::move(inputs), seed};
    }

private:
    const SceneInfo& scene_;
    Inputs defaults_;
};

/// Cases of a campaign's points. The common part of their canonical texts is written once; only the lines of factors
/// and expressions are written for each point.
class PointQuestions final : public Questions {
public:
    PointQuestions(const Campaign& campaign, designs::PointSet points)
        : space_(campaign.space),
          seed_(campaign.seed),
          points_(std::move(points)),
          common_(common_inputs()),
          asked_(skeleton({})) {
        if (!campaign.common_random_numbers.empty()) seeding_ = skeleton(campaign.common_random_numbers);
        find_unused();
    }

    [[nodiscard]] const designs::PointSet& points() const { return points_; }

    /// Completes `inputs`, which may have the values of another point; only varied ones are changed.
    void inputs(std::size_t point, Inputs& inputs) const {
        if (inputs.empty()) inputs = common_;
        for (const auto& one : asked_.varying)
            if (one.factor) inputs.find(one.name)->second = value(point, one);
        evaluate_expressions(space_.expressions, inputs);
    }
    void check(std::size_t point) const {
        if (space_.expressions.empty()) return;
        Inputs all;
        inputs(point, all);
        check_expressions(space_, all);
    }
    [[nodiscard]] std::string text(std::size_t point) const { return text(point, asked_); }
    /// Returns the seed. `text`: text of the point.
    [[nodiscard]] std::uint64_t seed(std::size_t point, const std::string& text, std::int64_t replicate) const {
        return campaign::case_seed(seed_, seeding_ ? this->text(point, *seeding_) : text, replicate);
    }
    [[nodiscard]] static CaseHash hash(std::string text, std::uint64_t seed) {
        add_canonical_seed(text, seed);
        return content_bits(text);
    }
    void make(std::size_t, const Place& place, Case& into) const override {
        std::string asked = text(place.point);
        into.scene = space_.scene->name;
        into.revision = space_.scene->revision;
        into.seed = seed(place.point, asked, place.replicate);
        into.id = id_of(hash(std::move(asked), into.seed));
        inputs(place.point, into.inputs);
    }
    void make_inputs(std::size_t, const Place& place, Inputs& into) const override { inputs(place.point, into); }

private:
    struct Varying {
        std::string before;  ///< the lines of the canonical text between the one before it and this one
        std::string name;
        std::optional<std::size_t> factor;  ///< none: an expression
        Value standard;
    };

    /// A canonical text whose lines of factors and expressions are still to be put in.
    struct Skeleton {
        std::vector<Varying> varying;  ///< sorted by name
        std::string rest;
    };

    /// Without the lines of those names.
    [[nodiscard]] Skeleton skeleton(const std::vector<std::string>& without) const {
        Skeleton made;
        const Inputs defaults = space_.scene->defaults();
        std::string text = begin_canonical(space_.scene->name, space_.scene->revision);
        for (const auto& [name, value] : common_) {
            if (std::ranges::count(without, name) > 0) continue;
            const auto factor = std::ranges::find(space_.factors, name, &Factor::name);
            const Value& standard = defaults.at(name);
            if (factor != space_.factors.end()) {
                const auto number = static_cast<std::size_t>(factor - space_.factors.begin());
                made.varying.push_back({std::exchange(text, {}), name, number, standard});
            } else if (std::ranges::find(space_.expressions, name, &Expression::name) != space_.expressions.end()) {
                made.varying.push_back({std::exchange(text, {}), name, std::nullopt, standard});
            } else if (value != standard) {
                add_canonical(text, name, value);
            }
        }
        made.rest = std::move(text);
        return made;
    }
    [[nodiscard]] std::string text(std::size_t point, const Skeleton& skeleton) const {
        std::string text;
        Inputs all;
        if (!space_.expressions.empty()) inputs(point, all);
        for (const auto& one : skeleton.varying) {
            text += one.before;
            if (const Value held = one.factor ? value(point, one) : all.find(one.name)->second; held != one.standard)
                add_canonical(text, one.name, held);
        }
        return text += skeleton.rest;
    }
    [[nodiscard]] Inputs common_inputs() const {
        Inputs inputs = space_.scene->defaults();
        for (const auto& [name, value] : space_.fixed) {
            Value& slot = inputs.at(name);
            slot = coerced(value, slot);
        }
        return inputs;
    }
    /// Decides once which factors have no `when` that holds: the questions are read by several threads.
    void find_unused() {
        const auto conditional = std::ranges::count_if(space_.factors, [](const Factor& f) { return !f.when.empty(); });
        if (std::ssize(space_.when) != conditional)
            throw std::logic_error("the conditions of the factors are not compiled");
        if (conditional == 0) return;
        std::vector<bool> unused(points_.size() * space_.factors.size());
        std::vector<std::size_t> counts(space_.when.size());  // points at which a clause holds
        Inputs inputs = common_;
        for (std::size_t p = 0; p < points_.size(); ++p) {
            for (const auto& one : asked_.varying)
                if (one.factor) inputs.find(one.name)->second = value(p, one);
            for (std::size_t k = 0; k < counts.size(); ++k) {
                const auto& [name, holds] = space_.when[k];
                if (holds(inputs)) {
                    ++counts[k];
                    continue;
                }
                inputs.find(name)->second = default_of(*space_.scene, name);
                unused[p * space_.factors.size() + number_of(name)] = true;
            }
        }
        for (std::size_t k = 0; k < counts.size(); ++k)
            if (counts[k] == 0 && points_.rows.empty()) refuse_unused(space_.when[k].factor);
        unused_ = std::move(unused);
    }
    [[nodiscard]] std::size_t number_of(const std::string& factor) const {
        return static_cast<std::size_t>(std::ranges::find(space_.factors, factor, &Factor::name) -
                                        space_.factors.begin());
    }
    [[noreturn]] void refuse_unused(const std::string& factor) const {
        throw input_error(path_of("$.factors", number_of(factor)) + ".when", space_.factors[number_of(factor)].when,
                          fmt::format("it is true at none of the {} points of the design: '{}' never counts",
                                      points_.size(), factor));
    }
    [[nodiscard]] Value value(std::size_t point, const Varying& one) const {
        if (!unused_.empty() && unused_[point * space_.factors.size() + *one.factor]) return one.standard;
        return points_.rows.empty() ? coerced(value_at(space_.factors, *one.factor, points_.point(point)), one.standard)
                                    : coerced(points_.rows[point][*one.factor], one.standard);
    }

    ParameterSpace space_;
    std::uint64_t seed_;
    designs::PointSet points_;
    Inputs common_;
    Skeleton asked_;                   ///< of the whole text
    std::optional<Skeleton> seeding_;  ///< of what the seed follows from, where that is less
    std::vector<bool> unused_;         ///< by point and factor: its `when` does not hold; empty: all count
};

}  // namespace

std::int64_t candidates_of(const Campaign& campaign) {
    return designs::design_named(campaign.design).size(campaign.request);
}

const stats::RuleInfo& Convergence::traits() const {
    const auto* const found = stats::find_rule(rule);
    if (found == nullptr) throw std::invalid_argument("no convergence rule is called '" + rule + "'");
    return *found;
}

std::int64_t least_block(const stats::RuleInfo& rule, std::int64_t sequences) {
    constexpr std::int64_t fewest = 4;
    return rule.of_sequences ? fewest * sequences : fewest;
}

std::int64_t default_block(std::int64_t points, std::int64_t sequences, std::int64_t least) {
    const std::int64_t part = std::min(points / checks_by_default, longest_default_block);
    return std::max(least, part - part % sequences);
}

namespace {

/// Checks with a model are fewer, see stats/assisted_convergence.hpp (features are not known here: four at most ask for
/// no later first check).
std::string never_converges_with_model(const Convergence& convergence, std::int64_t points) {
    const std::int64_t block = convergence.block;
    const auto next = [&](std::int64_t least) { return (least + block - 1) / block * block; };
    const std::int64_t first = next(stats::fewest_assisted_points);
    const std::int64_t second = next(first + std::max<std::int64_t>(1, first / stats::assisted_growth));
    if (second <= points) return {};
    return fmt::format(
        "convergence can never be found: the rule '{}' needs two checks, the first at {} points and the second at {} "
        "or more with a block of {}, and the design has {}",
        convergence.rule, first, second, block, points);
}

}  // namespace

std::string never_converges(const Campaign& campaign) {
    if (!campaign.convergence) return {};
    const std::int64_t points = candidates_of(campaign);
    const auto& convergence = *campaign.convergence;
    if (convergence.traits().of_model) return never_converges_with_model(convergence, points);
    const std::int64_t block = convergence.block;
    if (block > points)
        return fmt::format("convergence can never be checked: a block is {} points, and the design has {}", block,
                           points);
    if (2 * block > points)
        return fmt::format(
            "convergence can never be found: the rule '{}' needs two checks, and with a block of {} the {} points of "
            "the design give one",
            convergence.rule, block, points);
    return {};
}

void check_design(const Campaign& campaign) {
    (void)sample(campaign);
}

Cases unfold(const Campaign& campaign, const Filter& filter) {
    const auto questions = std::make_shared<const PointQuestions>(campaign, sample(campaign));
    const auto& points = questions->points();
    const std::size_t sequences = std::max<std::size_t>(points.sequences, 1);
    std::vector<Place> places;
    std::vector<CaseHash> hashes;
    const std::size_t most = points.size() * static_cast<std::size_t>(campaign.replicates);
    if (!filter) {
        places.reserve(most);
        hashes.reserve(most);
    }
    Inputs inputs;
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (filter) {
            questions->inputs(p, inputs);
            if (!filter(inputs)) continue;
        }
        questions->check(p);
        const std::string text = questions->text(p);
        const auto part = points.part.empty() ? static_cast<std::uint32_t>(p % sequences) : points.part[p];
        const auto ask = [&](std::int64_t replicate) {
            places.push_back({static_cast<std::uint32_t>(p), part, static_cast<std::uint32_t>(replicate)});
            hashes.push_back(PointQuestions::hash(text, questions->seed(p, text, replicate)));
        };
        if (!points.repeat.empty()) {
            ask(points.repeat[p]);
            continue;
        }
        for (std::int64_t replicate = 0; replicate < campaign.replicates; ++replicate) ask(replicate);
    }
    if (places.empty()) {
        throw input_error("$.where", fmt::format("\"{}\"", campaign.where),
                          fmt::format("it leaves none of the {} points of the design", points.size()));
    }
    places.shrink_to_fit();
    hashes.shrink_to_fit();
    return {std::move(places), std::move(hashes), questions};
}

Case make_case(const SceneInfo& scene, const Inputs& inputs, std::uint64_t seed) {
    const CaseMaker maker(scene);
    return maker.make(maker.completed(inputs), seed);
}

std::uint64_t case_seed(const Campaign& campaign, const Inputs& inputs, std::int64_t replicate) {
    const CaseMaker maker(campaign.scene());
    Inputs known = maker.completed(inputs);
    for (const auto& name : campaign.common_random_numbers)
        known.insert_or_assign(name, campaign.scene().find_parameter(name)->default_value);
    return case_seed(campaign.seed, maker.text(known, std::nullopt), replicate);
}

}  // namespace grainsweep::campaign
