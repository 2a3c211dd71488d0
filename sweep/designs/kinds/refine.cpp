#include "sweep/designs/refine.hpp"

#include "stats/confidence.hpp"
#include "sweep/designs/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

namespace grainsweep::designs {
namespace {

constexpr std::size_t pair = 2;  // repeats asked at once
constexpr double most_repeats = 1000;
constexpr std::size_t most_halvings = 50;  // beyond them no double lies between the ends of the bracket

/// When a level is decided, and when a bracket is narrow enough.
struct Aim {
    double threshold = 0, width = 0;
    std::size_t repeats = 1;
};

/// What a refine design is asked, checked.
struct Question {
    std::size_t factor = 0;  ///< number of the one refined
    Aim aim;
    std::vector<std::size_t> levels;  ///< of each factor; 1 for the one refined
    std::size_t combinations = 1;
};

Question question_of(const DesignRequest& request) {
    Question question;
    const std::string& name = request.word("factor");
    const auto found = std::ranges::find(request.factors, name, &Factor::name);
    if (found == request.factors.end() || !found->continuous())
        throw std::invalid_argument("factor '" + name + "' does not vary between two values");
    question.factor = static_cast<std::size_t>(found - request.factors.begin());
    question.aim.threshold = request.number("threshold");
    question.aim.width = request.number("width");
    question.aim.repeats = static_cast<std::size_t>(request.count("replicates"));
    const double range = found->number(1) - found->number(0);
    if (!(question.aim.width < range))
        throw std::invalid_argument("a width of " + std::to_string(question.aim.width) +
                                    " is the whole range of the factor '" + name + "' or more: nothing to refine");
    constexpr std::size_t most = 1'000'000;
    for (std::size_t j = 0; j < request.dimensions(); ++j) {
        const std::size_t levels = j == question.factor ? 1 : request.levels[j];
        if (levels == 0)
            throw std::invalid_argument("factor '" + request.factors[j].name +
                                        "' must be given by levels: a passage is sought along '" + name +
                                        "' for every combination of the others");
        if (question.combinations > most / levels)
            throw std::invalid_argument("the levels have more than 1000000 combinations");
        question.combinations *= levels;
        question.levels.push_back(levels);
    }
    return question;
}

/// Bisection for one combination.
class Search {
public:
    Search(const Aim& aim, const Factor& factor) : aim_(aim), factor_(factor) {
        for (const double end : {0.0, 1.0}) levels_.push_back({end, factor.number(end), {}, 0, 0});
    }

    /// What is asked next: numbers of levels, one for each repeat; none when done.
    [[nodiscard]] std::vector<std::size_t> wanted() {
        if (state_ != Bracket::State::open) return {};
        if (settled() && levels_[low_].asked > 0) {
            const double u = (levels_[low_].coordinate + levels_[high_].coordinate) / 2;
            levels_.push_back({u, factor_.number(u), {}, 0, 0});
        }
        std::vector<std::size_t> numbers;
        for (std::size_t k = 0; k < levels_.size(); ++k)
            if (!decided(levels_[k])) numbers.insert(numbers.end(), std::min(pair, aim_.repeats - levels_[k].asked), k);
        return numbers;
    }
    [[nodiscard]] const RefinedLevel& level(std::size_t number) const { return levels_[number]; }
    /// A repeat of this level is asked; `answer`: none where it is not known yet, NaN where there will be none.
    void ask(std::size_t number, const std::optional<double>& answer) {
        auto& level = levels_[number];
        ++level.asked;
        if (!answer) return;
        if (std::isfinite(*answer))
            level.answers.push_back(*answer);
        else
            ++level.unanswered;
    }
    /// Draws the conclusions when all answers to what was asked are known.
    void conclude() {
        if (state_ != Bracket::State::open || !settled()) return;
        if (std::ranges::any_of(levels_, [](const auto& one) { return one.answers.empty(); })) {
            state_ = Bracket::State::unanswered;
        } else if (levels_.size() == 2 && above(low_) == above(high_)) {
            state_ = above(low_) ? Bracket::State::above : Bracket::State::below;
        } else {
            const std::size_t last = levels_.size() - 1;
            if (last > high_) (above(last) == above(low_) ? low_ : high_) = last;
            constexpr double rounding = 1 + 1e-12;
            if (levels_[high_].value - levels_[low_].value <= aim_.width * rounding || last > most_halvings)
                state_ = Bracket::State::found;
        }
    }
    [[nodiscard]] Bracket bracket() const {
        Bracket known{state_, {}, levels_[low_], levels_[high_], 0};
        for (const auto& one : levels_) known.runs += one.asked;
        return known;
    }

private:
    [[nodiscard]] bool above(std::size_t number) const { return levels_[number].mean() >= aim_.threshold; }
    [[nodiscard]] bool decided(const RefinedLevel& level) const {
        if (level.asked >= aim_.repeats) return true;
        return level.answers.size() >= pair && std::abs(level.mean() - aim_.threshold) > level.half_width();
    }
    [[nodiscard]] bool settled() const {
        return std::ranges::all_of(levels_, [this](const auto& one) { return decided(one); });
    }

    Aim aim_;
    Factor factor_;
    std::vector<RefinedLevel> levels_;  ///< in the order asked: both ends, then middles
    std::size_t low_ = 0, high_ = 1;    ///< the ends of the bracket
    Bracket::State state_ = Bracket::State::open;
};

/// The levels of combination c, the last factor fastest; 0 for the factor refined.
std::vector<std::size_t> levels_at(const Question& question, std::size_t c) {
    std::vector<std::size_t> numbers(question.levels.size());
    for (std::size_t j = numbers.size(); j-- > 0;) {
        numbers[j] = c % question.levels[j];
        c /= question.levels[j];
    }
    return numbers;
}

/// All rounds that follow from the answers; the points of the last one are not all answered, or it asks nothing.
struct RefineCourse {
    Question question;
    std::vector<Search> searches;
    PointSet points;
};

RefineCourse course_of(const DesignRequest& request) {
    RefineCourse course{question_of(request), {}, {}};
    const auto& question = course.question;
    auto& points = course.points;
    const auto known = request.answers.find(request.word("observable"));
    const std::vector<std::optional<double>> none;
    const auto& answers = known == request.answers.end() ? none : known->second;
    const std::size_t d = request.dimensions();
    points.dimensions = d;
    for (std::size_t c = 0; c < question.combinations; ++c)
        course.searches.emplace_back(question.aim, request.factors[question.factor]);
    for (bool answered = true; answered;) {
        const std::size_t before = points.repeat.size();
        for (std::size_t c = 0; c < question.combinations; ++c) {
            auto& search = course.searches[c];
            const auto others = levels_at(question, c);
            for (const std::size_t number : search.wanted()) {
                const auto& level = search.level(number);
                for (std::size_t j = 0; j < d; ++j)
                    points.coordinates.push_back(j == question.factor ? level.coordinate
                                                                      : (static_cast<double>(others[j]) + 0.5) /
                                                                            static_cast<double>(question.levels[j]));
                points.part.push_back(static_cast<std::uint32_t>(c));
                points.repeat.push_back(static_cast<std::uint32_t>(level.asked));
                const std::size_t point = points.repeat.size() - 1;
                const auto answer = point < answers.size() ? answers[point] : std::nullopt;
                search.ask(number, answer);
                if (!answer) answered = false;
            }
        }
        if (points.repeat.size() == before) break;
        if (answered)
            for (auto& search : course.searches) search.conclude();
    }
    return course;
}

}  // namespace

double RefinedLevel::mean() const {
    if (answers.empty()) return std::numeric_limits<double>::quiet_NaN();
    return std::accumulate(answers.begin(), answers.end(), 0.0) / static_cast<double>(answers.size());
}

double RefinedLevel::half_width() const {
    return stats::student_half_width(answers);
}

const char* to_string(Bracket::State state) {
    switch (state) {
        case Bracket::State::open:
            return "open";
        case Bracket::State::found:
            return "found";
        case Bracket::State::below:
            return "below throughout";
        case Bracket::State::above:
            return "above throughout";
        case Bracket::State::unanswered:
            return "without an answer";
    }
    return "";
}

std::vector<Bracket> brackets(const DesignRequest& request) {
    const auto course = course_of(request);
    std::vector<Bracket> found;
    for (std::size_t c = 0; c < course.searches.size(); ++c) {
        found.push_back(course.searches[c].bracket());
        found.back().levels = levels_at(course.question, c);
        found.back().levels.erase(found.back().levels.begin() + static_cast<std::ptrdiff_t>(course.question.factor));
    }
    return found;
}

DesignInfo refine_design() {
    using enum OptionSpec::Names;
    using Kind = Field::Kind;
    return {
        .name = "refine",
        .summary =
            "Where an answer passes a threshold along one factor, for every combination of the levels of the "
            "others: bisection with repeats, round by round. A passage within 1/128 of the range takes 9 runs of a "
            "response without scatter, where an even lattice takes 129.",
        .options = {{needed({"factor", Kind::text, "the factor along which the threshold is passed"}), false, factors},
                    {needed({"observable", Kind::text, "the scalar that passes it"}), false, observables},
                    {needed({"threshold", Kind::number, "the value it passes, in its unit"})},
                    {needed({"width", Kind::number,
                             "width of the bracket, in the unit of the factor, at which it is done", "",
                             positive_number})},
                    {count_field("replicates", 1, most_repeats, "1",
                                 "repeats of a level at most, with other seeds: two, then two more at a time, until "
                                 "the 95 % interval of their mean excludes the threshold; 1: every level is run once "
                                 "and decides as it is")}},
        .grows = true,
        .brackets = true,
        .rests_on = [](const DesignRequest& request) { return std::vector{request.word("observable")}; },
        .beginning = Beginning::corner,
        .size =
            [](const DesignRequest& request) { return static_cast<std::int64_t>(course_of(request).points.size()); },
        .sample = [](const DesignRequest& request) { return course_of(request).points; }};
}

}  // namespace grainsweep::designs
