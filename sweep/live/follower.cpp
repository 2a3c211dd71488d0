#include "sweep/live/follower.hpp"

#include "sweep/files/system_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <iterator>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

namespace grainsweep::live {
namespace {

using campaign::JsonText;

std::int64_t whole(const store::Table::Cell& cell) {
    const auto* number = std::get_if<std::int64_t>(&cell);
    return number == nullptr ? 0 : *number;
}
std::string words(const store::Table::Cell& cell) {
    const auto* text = std::get_if<std::string>(&cell);
    return text == nullptr ? std::string() : *text;
}

double seconds_from(std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

constexpr double rest_after_whole = 100;  // times the duration of reading all cases
constexpr double idle_seconds = 3;        // without a change, after which the file is closed
constexpr double retry_seconds = 2;       // after an error
constexpr std::size_t most_keys = 200'000'000;
constexpr double longest_reading = 10;  // of processor time in one question

/// Differs between two results of a case; never 0. Beginning an attempt leaves it as it is.
std::uint32_t mark_of(std::string_view outcome, const store::Table::Cell& wall_seconds, std::int64_t failures) {
    const auto* seconds = std::get_if<double>(&wall_seconds);
    const std::size_t hash = std::hash<std::string_view>{}(outcome) ^
                             std::hash<double>{}(seconds == nullptr ? -1 : *seconds) * 0x9E3779B97F4A7C15U ^
                             static_cast<std::size_t>(failures) * 0xC2B2AE3D27D4EB4FU;
    return static_cast<std::uint32_t>(hash >> 32U ^ hash) | 1U;
}

}  // namespace

Follower::Follower(std::filesystem::path database, std::function<bool()> ended)
    : database_(std::move(database)), ended_(std::move(ended)) {
    (void)poll();
    anew_ = false;
    store_.reset();
}

void Follower::begin() {
    const auto now = stamp();
    known_.clear();
    first_open_ = 1;
    rows_ = 0;
    while (!fresh(1).empty()) {
    }
    seen_ = seen_whole_ = now;
}

store::Store& Follower::store() {
    used_ = Clock::now();
    if (!store_) store_.emplace(database_, store::Store::Mode::read);
    store_->limit(longest_reading, ended_);
    return *store_;
}

Follower::Stamp Follower::stamp() const {
    Stamp now;
    struct statx about {};
    if (::statx(AT_FDCWD, database_.c_str(), 0, STATX_BASIC_STATS | STATX_BTIME, &about) != 0) return now;
    const bool has_birth = (about.stx_mask & STATX_BTIME) != 0;
    now.file = {
        static_cast<std::uint64_t>(about.stx_dev_major) << 32U | about.stx_dev_minor, about.stx_ino,
        has_birth ? static_cast<std::uint64_t>(about.stx_btime.tv_sec) * 1'000'000'000U + about.stx_btime.tv_nsec : 0U};
    std::error_code absent;
    auto log = database_;
    log += "-wal";
    now.bytes = about.stx_size;
    now.log_bytes = std::filesystem::file_size(log, absent);
    now.written = std::filesystem::last_write_time(database_, absent);
    now.log_written = std::filesystem::last_write_time(log, absent);
    return now;
}

std::vector<Follower::Settled> Follower::fresh(std::int64_t first) {
    std::vector<Settled> found;
    first_open_ = first;
    const auto each = [&](const std::vector<store::Table::Cell>& row) {
        const auto key = static_cast<std::size_t>(whole(row[0]));
        if (whole(row[0]) == first_open_ && found.size() < most_at_once) ++first_open_;
        if (key > most_keys) throw SystemError(fmt::format("'{}': case number {}", database_.string(), key));
        if (known_.size() <= key) known_.resize(key + 1 + key / 2, 0);
        const auto mark = mark_of(words(row[1]), row[4], whole(row[5]));
        if (known_[key] == mark || found.size() >= most_at_once) return;
        known_[key] = mark;
        found.push_back({whole(row[0]), whole(row[2]), words(row[3]), words(row[1])});
    };
    const auto ask = [&](const std::string& sql, const auto& take) {
        store().query(
            sql, {}, [](const auto&) {}, take);
    };
    ask(fmt::format("SELECT case_key, outcome, attempts, case_id, wall_seconds, failures FROM sim_case "
                    "WHERE case_key >= {} AND outcome IS NOT NULL ORDER BY case_key",
                    first),
        each);
    if (first == 1)
        ask("SELECT count(*) FROM sim_case", [&](const auto& row) {
            const auto rows = static_cast<std::size_t>(whole(row[0]));
            anew_ = std::exchange(rows_, rows) != rows || anew_;
        });
    return found;
}

std::vector<JsonText> Follower::told(std::span<const Settled> settled) {
    auto& store = this->store();
    std::map<std::int64_t, JsonText> values, reasons;
    std::string keys;
    for (const auto& one : settled) fmt::format_to(std::back_inserter(keys), "{}{}", keys.empty() ? "" : ",", one.key);
    store.query(
        fmt::format("SELECT o.case_key, b.name, o.value FROM observation AS o JOIN observable AS b "
                    "USING (observable_id) WHERE o.case_key IN ({}) AND o.sample = 0 AND b.shape = 'scalar'",
                    keys),
        {}, [](const auto&) {},
        [&](const auto& row) {
            if (const auto* number = std::get_if<double>(&row[2]))
                values.try_emplace(whole(row[0]), JsonText::object()).first->second.add(words(row[1]), *number);
        });
    store.query(
        fmt::format("SELECT case_key, message FROM attempt WHERE case_key IN ({}) AND message <> '' "
                    "ORDER BY case_key, number",
                    keys),
        {}, [](const auto&) {},
        [&](const auto& row) { reasons.insert_or_assign(whole(row[0]), JsonText(words(row[1]))); });
    std::vector<JsonText> results;
    for (const auto& one : settled) {
        const auto known = values.find(one.key);
        results.push_back({{"case", one.id},
                           {"outcome", one.outcome},
                           {"attempts", one.attempts},
                           {"values", known == values.end() ? JsonText::object() : known->second}});
        const auto reason = reasons.find(one.key);
        if (reason != reasons.end()) results.back().add("reason", reason->second);
    }
    return results;
}

std::vector<JsonText> Follower::poll() {
    const auto now = stamp();
    try {
        if (now.file == decltype(now.file){}) {  // moved or deleted: what it held stays on the page
            store_.reset();
            return {};
        }
        if (!error_.empty() && seconds_from(failed_) < retry_seconds) return {};
        if (!seen_ || seen_->file != now.file) {
            store_.reset();
            begin();
            anew_ = true;
        }
        auto results = read(now);
        if (store_ && seconds_from(used_) > idle_seconds) store_.reset();
        error_.clear();
        return results;
    } catch (const std::exception& error) {
        store_.reset();
        error_ = error.what();
        failed_ = Clock::now();
        seen_.reset();
        seen_whole_.reset();
        return {};
    }
}

std::vector<JsonText> Follower::read(const Stamp& now) {
    constexpr std::size_t in_one_question = 500;
    const bool whole_due = seen_whole_ != now && seconds_from(looked_whole_) >= rest_after_whole * whole_seconds_;
    if (seen_ == now && !whole_due) return {};
    const auto start = Clock::now();
    const auto settled = fresh(whole_due ? 1 : first_open_);
    if (settled.size() < most_at_once) {
        seen_ = now;
        if (whole_due) seen_whole_ = now;
    }
    if (whole_due) {
        looked_whole_ = Clock::now();
        whole_seconds_ = seconds_from(start);
    }
    std::vector<JsonText> results;
    results.reserve(settled.size());
    for (std::size_t first = 0; first < settled.size(); first += in_one_question)
        for (auto& one : told(std::span(settled).subspan(first, std::min(in_one_question, settled.size() - first))))
            results.push_back(std::move(one));
    return results;
}

bool Follower::in_place() const {
    std::error_code error;
    return std::filesystem::exists(database_, error);
}

bool Follower::is_settled(std::string_view case_id) {
    try {
        return store().is_settled(case_id);
    } catch (const std::exception&) {
        return false;
    }
}

bool Follower::is_being_written() {
    try {
        return store().is_being_written();
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace grainsweep::live
