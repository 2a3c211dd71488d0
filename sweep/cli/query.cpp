#include "sweep/cli/query.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/report/workbook.hpp"
#include "sweep/store/store.hpp"

#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Outcome;
using report::Format;
using store::Store;
using store::Table;

constexpr double grace_seconds = 0.5, longest = 1e9;

/// Returns the text that a signal handler writes.
std::string& last_words() {
    static std::string words;
    return words;
}

void end_here(int) {
    const auto& words = last_words();
    (void)!::write(STDERR_FILENO, words.data(), words.size());
    ::_exit(2);
}

void set_timer(double seconds) {
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole));
    ::setitimer(ITIMER_PROF, &timer, nullptr);  // processor time of the whole process
}

/// Guard that ends the program with exit code 2 and the sentence after this processor time; 0: never. It backs up a
/// softer limit of the same time: a function of SQLite may run for hours between two checks of the time.
class HardStop {
public:
    HardStop(double seconds, const std::string& sentence) {
        if (!(seconds > 0)) return;
        last_words() = "grainsweep: " + sentence + "\n";
        std::signal(SIGPROF, end_here);
        set_timer(std::min(seconds + grace_seconds, longest));
    }
    HardStop(const HardStop&) = delete;
    HardStop& operator=(const HardStop&) = delete;
    ~HardStop() { set_timer(0); }
};

constexpr FileKind workbook_kind{"workbook", "pk\x03\x04"};  // a ZIP archive, in lower case

/// The scenes of the campaigns, read as `query` reads everything, without checking.
std::vector<std::string> scenes_of(const Store& archive, const Store::QueryLimits& limits) {
    std::vector<std::string> scenes;
    archive.query(
        "SELECT DISTINCT scene FROM campaign", limits, [](const auto&) {},
        [&](const auto& row) {
            if (const auto* scene = std::get_if<std::string>(&row.front())) scenes.push_back(*scene);
        });
    return scenes;
}

/// Returns "cases of this database without results: 2 unstable; of a completed one "; empty: all are completed.
std::string cases_without_results(const Store& archive, const Store::QueryLimits& limits) {
    std::string listed;
    archive.query(
        "SELECT coalesce(outcome, 'waiting'), count(*) FROM sim_case WHERE outcome IS NOT 'completed' GROUP BY outcome",
        limits, [](const auto&) {},
        [&](const auto& row) {
            listed += fmt::format("{}{} {}", listed.empty() ? "" : ", ", std::get<std::int64_t>(row[1]),
                                  std::get<std::string>(row[0]));
        });
    return listed.empty() ? listed
                          : fmt::format("cases of this database without results: {}; of a completed one ", listed);
}

/// Columns of a query that are named as a scalar of a scene, and their rows without a value.
class Gaps {
public:
    explicit Gaps(std::vector<std::string> scenes) : scenes_(std::move(scenes)) {}

    void begin(const std::vector<std::string>& columns) {
        for (std::size_t k = 0; k < columns.size(); ++k) {
            if (columns[k] == "outcome") outcome_ = k;
            for (const auto& scene : scenes_)
                if (std::string why = campaign::why_absent(scene, columns[k]); !why.empty()) {
                    gaps_.push_back({k, columns[k], std::move(why), 0});
                    break;
                }
        }
    }
    void add(const std::vector<Table::Cell>& row) {
        const auto* outcome = outcome_ ? std::get_if<std::string>(&row[*outcome_]) : nullptr;
        if (outcome_ && (outcome == nullptr || *outcome != campaign::to_string(Outcome::completed))) return;
        ++rows_;
        for (Gap& gap : gaps_)
            if (std::holds_alternative<std::monostate>(row[gap.column])) ++gap.rows;
    }
    /// `others`: returns the cases that are not completed, in words, which rows without outcomes may be of.
    template <class Others>
    void print(const Others& others) const {
        for (const Gap& gap : gaps_)
            if (gap.rows > 0)
                std::cerr << fmt::format("note: {} of {} rows{} have no {}: {}it is undefined where {}\n", gap.rows,
                                         rows_, outcome_ ? " of completed cases" : "", gap.name,
                                         outcome_ ? "" : others(), gap.why);
    }

private:
    struct Gap {
        std::size_t column;
        std::string name, why;
        std::int64_t rows;
    };
    std::vector<std::string> scenes_;
    std::vector<Gap> gaps_;
    std::optional<std::size_t> outcome_;
    std::int64_t rows_ = 0;
};

/// Returns the unit of a column with the name of a parameter or a scalar, if all scenes agree; else empty.
std::string unit_of(const std::vector<std::string>& scenes, const std::string& column) {
    if (column == "wall_seconds" || column == "cpu_seconds") return "s";
    std::optional<std::string> unit;
    for (const auto& name : scenes) {
        const auto scene = find_scene(name);
        const auto* parameter = scene == nullptr ? nullptr : scene->find_parameter(column);
        const auto* observable = scene == nullptr ? nullptr : scene->find_observable(column);
        if (parameter == nullptr && observable == nullptr) continue;
        const auto& here = parameter != nullptr ? parameter->unit : observable->unit;
        if (unit && *unit != here) return {};
        unit = here;
    }
    return !unit || *unit == "1" ? std::string() : *unit;
}

/// Returns the origin of the rows for the reader of the workbook.
Table provenance_of(const Store& archive, const QueryRequest& request, const Store::QueryLimits& limits) {
    Table table{{"what", "value"}, {}};
    const auto add = [&](std::string what, std::string value) {
        table.rows.push_back({std::move(what), std::move(value)});
    };
    add("statement", request.sql);
    add("database", std::filesystem::path(request.database).filename().string());
    add("written by", "grainsweep " + build_version());
    std::vector<std::string> names;
    const auto each = [&](const char* sql, std::string_view kind) {
        archive.query(
            sql, limits, [&](const auto& columns) { names = columns; },
            [&](const auto& row) {
                std::string facts;
                for (std::size_t j = 0; j < row.size(); ++j) {
                    const auto* text = std::get_if<std::string>(&row[j]);
                    const auto* whole = std::get_if<std::int64_t>(&row[j]);
                    if (text == nullptr && whole == nullptr) continue;
                    facts += fmt::format("{}{} {}", facts.empty() ? "" : "; ", names[j],
                                         text != nullptr ? *text : std::to_string(*whole));
                }
                add(std::string(kind), facts);
            });
    };
    each("SELECT name, scene, revision FROM campaign ORDER BY campaign_id", "campaign");
    each(
        "SELECT c.name AS campaign, p.start, p.version, p.\"commit\", p.compiler, p.instruction_path AS instructions, "
        "p.processor, p.settled AS finished_attempts FROM provenance p JOIN campaign c USING (campaign_id) "
        "ORDER BY p.provenance_id",
        "run");
    return table;
}

/// Refuses before anything is read: a workbook is bytes, no text.
void check_output(const QueryRequest& request, Format format) {
    if (format != Format::xlsx) {
        if (!request.output.empty())
            throw campaign::input_error("-o", fmt::format("'{}'", request.output),
                                        "only a workbook (--format xlsx) is written to a file; redirect other "
                                        "formats with >");
        return;
    }
    if (!request.output.empty()) return check_page_file("-o", request.output, request.database, workbook_kind);
    if (::isatty(STDOUT_FILENO) != 0)
        throw campaign::input_error("--format", "'xlsx'", "a workbook is not shown on a terminal; name a file with -o");
}

void write_workbook(const std::string& bytes, const std::string& output) {
    if (!output.empty()) return write_page_file(output, bytes);
    std::cout.flush();  // std::cout shows control characters; these bytes are no text
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
}

}  // namespace

int query(const QueryRequest& request, Format format) {
    constexpr std::int64_t most_memory = std::int64_t{1} << 30U;
    const double seconds = request.seconds;
    if (!(seconds >= 0)) throw campaign::input_error("--limit-seconds", std::to_string(seconds), "0 or more");
    check_output(request, format);
    const Store archive(request.database, Store::Mode::read);
    const Store::QueryLimits limits{seconds, most_memory};
    const HardStop stop(seconds, fmt::format("SQL: it takes too long (limits: {} s of processor time, {} MiB).",
                                             campaign::shortest(seconds), most_memory >> 20U));
    const auto scenes = scenes_of(archive, limits);
    Gaps gaps(scenes);
    const auto ask = [&](const auto& begin, const auto& add) {
        archive.query(
            request.sql, limits,
            [&](const auto& columns) {
                begin(columns);
                gaps.begin(columns);
            },
            [&](const auto& row) {
                add(row);
                gaps.add(row);
            });
    };
    if (format == Format::text) {  // columns are aligned over all rows
        Table table;
        ask([&](const auto& columns) { table.columns = columns; }, [&](const auto& row) { table.rows.push_back(row); });
        report::write(std::cout, table, format);
    } else if (format == Format::xlsx) {
        report::Workbook book;
        ask(
            [&](const auto& columns) {
                std::vector<std::string> units;
                for (const auto& column : columns) units.push_back(unit_of(scenes, column));
                book.begin(columns, units);
            },
            [&](const auto& row) { book.add(row); });
        if (const auto cut = book.cut_texts(); cut > 0)
            std::cerr << fmt::format("note: {} texts are cut at 32767 characters, the most that a cell holds\n", cut);
        write_workbook(book.finish(provenance_of(archive, request, limits)), request.output);
    } else {
        report::RowWriter rows(std::cout, format);
        ask([&](const auto& columns) { rows.begin(columns); }, [&](const auto& row) { rows.add(row); });
        rows.end();
    }
    gaps.print([&] { return cases_without_results(archive, limits); });
    return 0;
}

}  // namespace grainsweep::cli
