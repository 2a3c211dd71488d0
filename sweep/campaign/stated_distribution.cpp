#include "sweep/campaign/stated_distribution.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/overloaded.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <sstream>

namespace grainsweep::campaign {

namespace {

std::string values_text(std::span<const double> values) {
    std::string text;
    for (const double x : values) text.append(" ").append(shortest(x));
    return text;
}

std::string hash_of_columns(const stats::JointSample& sample) {
    std::string text;
    for (std::size_t k = 0; k < sample.columns(); ++k) text += values_text(sample.column(k)) + '\n';
    return content_hash(text);
}

/// Returns the words of a text as numbers; NaN for a word that is no number.
std::vector<double> numbers_in_words(std::string_view text) {
    std::vector<double> numbers;
    for (const char* at = text.data(); at != text.data() + text.size();) {
        const char* const end = text.data() + text.size();
        const char* stop = std::find(at, end, ' ');
        if (stop == at) {
            ++at;
            continue;
        }
        double number = std::numeric_limits<double>::quiet_NaN();
        std::from_chars(at, stop, number);
        numbers.push_back(number);
        at = stop;
    }
    return numbers;
}

StatedColumn column_in(std::string_view text) {
    StatedColumn stated;
    const auto colon = std::min(text.find(':'), text.size());
    std::istringstream words{std::string(text.substr(0, colon))};
    std::string of, in;
    std::size_t count = 0;
    words >> stated.column >> of >> count >> in >> stated.sample;
    stated.column -= 1;
    stated.values = numbers_in_words(text.substr(std::min(colon + 1, text.size())));
    return stated;
}

}  // namespace

std::string stated_text(const stats::Distribution& distribution) {
    const auto within = [&] {
        return fmt::format(" within {} {}", shortest(distribution.low()), shortest(distribution.high()));
    };
    return std::visit(
        Overloaded{[&](const stats::Normal& form) {
                       return fmt::format("normal {} {}", shortest(form.mean), shortest(form.sd)) + within();
                   },
                   [&](const stats::Lognormal& form) {
                       return fmt::format("lognormal {} {}", shortest(form.median), shortest(form.sigma)) + within();
                   },
                   [&](const stats::Weibull& form) {
                       return fmt::format("weibull {} {}", shortest(form.scale), shortest(form.shape)) + within();
                   },
                   [&](const stats::Gumbel& form) {
                       return fmt::format("gumbel {} {}", shortest(form.location), shortest(form.scale)) + within();
                   },
                   [](const stats::Triangular& form) {
                       return fmt::format("triangular {} {} {}", shortest(form.low), shortest(form.mode),
                                          shortest(form.high));
                   },
                   [](const stats::Beta& form) {
                       return fmt::format("beta {} {} {} {}", shortest(form.low), shortest(form.high), shortest(form.a),
                                          shortest(form.b));
                   },
                   [](const stats::SampleColumn& form) {
                       return fmt::format("sample {} of {} in {}:{}", form.column + 1, form.sample->columns(),
                                          hash_of_columns(*form.sample), values_text(form.sample->column(form.column)));
                   }},
        distribution.form());
}

std::variant<std::monostate, stats::Distribution, StatedColumn> distribution_in(std::string_view text) {
    const auto space = std::min(text.find(' '), text.size());
    const auto kind = text.substr(0, space);
    const auto rest = text.substr(space);
    if (kind == "sample") return column_in(rest);
    const auto numbers = numbers_in_words(rest);  // "within" is none
    if (kind == "normal" && numbers.size() == 5)
        return stats::Distribution(stats::Normal{numbers[0], numbers[1]}, numbers[3], numbers[4]);
    if (kind == "lognormal" && numbers.size() == 5)
        return stats::Distribution(stats::Lognormal{numbers[0], numbers[1]}, numbers[3], numbers[4]);
    if (kind == "weibull" && numbers.size() == 5)
        return stats::Distribution(stats::Weibull{numbers[0], numbers[1]}, numbers[3], numbers[4]);
    if (kind == "gumbel" && numbers.size() == 5)
        return stats::Distribution(stats::Gumbel{numbers[0], numbers[1]}, numbers[3], numbers[4]);
    if (kind == "triangular" && numbers.size() == 3)
        return stats::Distribution(stats::Triangular{numbers[0], numbers[1], numbers[2]});
    if (kind == "beta" && numbers.size() == 4)
        return stats::Distribution(stats::Beta{numbers[0], numbers[1], numbers[2], numbers[3]});
    return {};
}

std::string_view without_values(std::string_view text) {
    return text.find(" sample ") == std::string_view::npos ? text : text.substr(0, text.find(':'));
}

std::string described(const stats::Distribution& distribution) {
    return std::visit(
        Overloaded{
            [](const stats::Normal& form) { return fmt::format("normal, mean {:.6g}, sd {:.6g}", form.mean, form.sd); },
            [](const stats::Lognormal& form) {
                return fmt::format("lognormal, median {:.6g}, sigma {:.6g}", form.median, form.sigma);
            },
            [](const stats::Weibull& form) {
                return fmt::format("weibull, scale {:.6g}, shape {:.6g}", form.scale, form.shape);
            },
            [](const stats::Gumbel& form) {
                return fmt::format("gumbel, location {:.6g}, scale {:.6g}", form.location, form.scale);
            },
            [](const stats::Triangular& form) {
                return fmt::format("triangular, low {:.6g}, mode {:.6g}, high {:.6g}", form.low, form.mode, form.high);
            },
            [](const stats::Beta& form) {
                return fmt::format("beta, low {:.6g}, high {:.6g}, a {:.6g}, b {:.6g}", form.low, form.high, form.a,
                                   form.b);
            },
            [](const stats::SampleColumn& form) {
                return form.sample->columns() == 1
                           ? fmt::format("sample of {} values", form.sample->rows())
                           : fmt::format("column {} of {} of a sample of {} rows", form.column + 1,
                                         form.sample->columns(), form.sample->rows());
            }},
        distribution.form());
}

}  // namespace grainsweep::campaign
