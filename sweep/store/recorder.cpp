#include "sweep/store/recorder.hpp"

#include "sweep/campaign/overloaded.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace grainsweep::store {
namespace {

using campaign::Overloaded;

// A group is as large as what arrived while the last one was being synced, within these bounds.
constexpr std::size_t group_rows = 256;
constexpr auto idle_look = std::chrono::seconds(1);
constexpr auto group_wait = std::chrono::milliseconds(10);

// Number of places of a campaign that are entered between two groups. It is small at first, so that the first answers
// do not wait, and grows to as many as take about a second. Large pieces are cheaper, because ids are spread over their
// index and each piece writes most pages of the index.
constexpr std::size_t first_piece = 8192, largest_piece = 131'072;

// Entries and samples that may wait, some 25 MB: more than a disk that works leaves behind.
constexpr std::size_t most_waiting = 250'000;

std::size_t weight_of(const Recorder::Entry& entry) {
    constexpr std::size_t of_an_entry = 8;
    std::size_t samples = 0;
    if (const auto* result = std::get_if<campaign::CaseResult>(&entry)) {
        for (const auto& [name, series] : result->observations.series) samples += series.size();
    }
    return of_an_entry + samples;
}

}  // namespace

Recorder::Recorder(Store& store)
    : store_(store), enrols_(store.enrols()), piece_(first_piece), thread_([this] { run(); }) {}

Recorder::~Recorder() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Recorder::rethrow() {
    if (failure_) std::rethrow_exception(failure_);
}

void Recorder::write(Entry entry) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return failure_ || weight_ < most_waiting; });
    rethrow();
    weight_ += weight_of(entry);
    waiting_.push_back(std::move(entry));
    if (waiting_.size() == 1 || waiting_.size() >= group_rows) changed_.notify_all();
}

std::vector<campaign::CaseResult> Recorder::take_durable() {
    const std::lock_guard lock(mutex_);
    rethrow();
    return std::exchange(durable_, {});
}

void Recorder::drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return failure_ || (waiting_.empty() && !busy_ && !enrols_); });
    rethrow();
}

void Recorder::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        if (!changed_.wait_for(lock, idle_look, [this] { return closing_ || !waiting_.empty() || enrols_; })) {
            // Nothing to write; a file that is gone must not be found out an hour later.
            try {
                store_.require_in_place();
                continue;
            } catch (...) {
                failure_ = std::current_exception();
            }
            changed_.notify_all();
            return;
        }
        if (waiting_.empty() && closing_) return;
        if (!closing_ && !enrols_)
            changed_.wait_for(lock, group_wait, [this] { return closing_ || waiting_.size() >= group_rows; });
        if (!write_waiting(lock)) return;
    }
}

bool Recorder::write_waiting(std::unique_lock<std::mutex>& lock) {
    std::vector<Entry> group = std::exchange(waiting_, {});
    if (std::exchange(weight_, 0) >= most_waiting) changed_.notify_all();
    busy_ = true;
    lock.unlock();
    std::vector<campaign::CaseResult> kept;
    std::exception_ptr failure;
    bool enrols = false;
    try {
        if (!group.empty()) write_group(group, kept);
        if (enrols_) store_.enrol_more(std::exchange(piece_, std::min(2 * piece_, largest_piece)));
        enrols = store_.enrols();
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    enrols_ = enrols;
    failure_ = failure;
    if (!failure) std::ranges::move(kept, std::back_inserter(durable_));
    changed_.notify_all();
    return !failure;
}

void Recorder::write_group(std::vector<Entry>& group, std::vector<campaign::CaseResult>& kept) {
    store_.group([&] {
        for (auto& entry : group) {
            std::visit(Overloaded{[&](const Begun& begun) { store_.begin(begun.attempt, *begun.computer); },
                                  [&](campaign::CaseResult& result) {
                                      if (store_.finish(result)) kept.push_back(std::move(result));
                                  },
                                  [&](const Checked& c) { store_.record(c.campaign, c.row); },
                                  [&](const Stopped& s) { store_.stop(s.campaign, s.points); }},
                       entry);
        }
    });
}

}  // namespace grainsweep::store
