#include "sweep/schedule/plan.hpp"

#include <algorithm>
#include <cassert>

namespace grainsweep::schedule {
namespace {

using campaign::Outcome;

// The end begins where what is left would take all workers so many times the longest case that is left. At 1 the others
// would be done just when the longest is; 2 leaves room for predictions that are wrong by as much.
constexpr double longest_cases_left = 2;

// Less than this is no headway: a case that is given back must have come further than the last time.
constexpr double headway = 0.01;

bool good(Outcome outcome) {
    return outcome == Outcome::completed || outcome == Outcome::skipped;
}

}  // namespace

Plan::Plan(std::vector<campaign::Case> questions, std::span<const History> histories, std::vector<double> predicted,
           std::vector<std::size_t> places, const Rules& rules, std::span<const std::int64_t> blocks)
    : places_(std::move(places)), rules_(rules) {
    assert(questions.size() == histories.size() && questions.size() == predicted.size());
    assert(blocks.empty() || blocks.size() == questions.size());
    entries_.reserve(questions.size());
    for (std::size_t i = 0; i < questions.size(); ++i) {
        Entry entry{std::move(questions[i]), histories[i].attempts, histories[i].failures, predicted[i]};
        index_.emplace(entry.question.id, i);
        const auto& known = histories[i].outcome;
        const bool asked_again = known && rules_.again == known;
        if (asked_again) entry.failures = 0;
        const bool exhausted = entry.failures >= rules_.attempts;
        const bool decided = known && !asked_again && (settles(*known) || exhausted);
        if (!histories[i].asked) {
            entry.decided = decided;
        } else if (++tally_.questions; decided) {
            decide(entry, *known);
        } else {
            queue_.push_back(i);
            tally_.predicted_left += entry.predicted;
        }
        entries_.push_back(std::move(entry));
    }
    order_the_end(blocks);
}

void Plan::order_the_end(std::span<const std::int64_t> blocks) {
    const auto limit = static_cast<std::size_t>(rules_.max_cases);
    const std::size_t end = limit > 0 ? std::min(limit, queue_.size()) : queue_.size();
    const auto length = [this](std::size_t question) { return entries_[question].predicted; };
    const auto block = [&](std::size_t question) { return blocks.empty() ? 0 : blocks[question]; };
    const std::vector<std::size_t> in_order(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(end));
    double left = 0;
    for (const auto question : in_order) left += length(question);

    // Longest first, of equally long ones the first, block by block.
    std::vector<std::size_t> by_length = in_order;
    std::ranges::stable_sort(by_length, [&](std::size_t a, std::size_t b) {
        return block(a) != block(b) ? block(a) < block(b) : length(a) > length(b);
    });
    std::vector<bool> taken(entries_.size(), false);
    auto longest = by_length.begin();
    auto first = in_order.begin();
    for (std::size_t at = 0; at < end; ++at) {
        while (taken[*first]) ++first;
        while (taken[*longest]) ++longest;
        const bool near_the_end =
            left <=
            longest_cases_left * static_cast<double>(std::max<std::size_t>(rules_.workers, 1)) * length(*longest);
        const std::size_t next = near_the_end ? *longest : *first;
        queue_[at] = next;
        taken[next] = true;
        left -= length(next);
    }
}

std::optional<double> Plan::next_predicted() const {
    if (closed_ || queue_.empty()) return std::nullopt;
    const auto limit = static_cast<std::size_t>(rules_.max_cases);
    if (limit > 0 && tally_.settled_now + tally_.failed_now + running_ >= limit) return std::nullopt;
    if (too_many_failures()) return std::nullopt;
    return entries_[queue_.front()].predicted;
}

std::size_t Plan::waiting() const {
    if (!next_predicted()) return 0;
    const auto limit = static_cast<std::size_t>(rules_.max_cases);
    return limit == 0 ? queue_.size()
                      : std::min(queue_.size(), limit - (tally_.settled_now + tally_.failed_now + running_));
}

std::optional<Plan::Start> Plan::next() {
    if (!next_predicted()) return std::nullopt;
    Entry& entry = entries_[queue_.front()];
    queue_.pop_front();
    entry.running = true;
    ++running_;
    ++entry.attempts;
    return Start{{entry.question.id, entry.attempts}, &entry.question, entry.predicted};
}

void Plan::move_on(Entry& entry, double share) {
    const double step = (share - entry.share.value_or(0)) * entry.predicted;
    tally_.predicted_left -= step;
    tally_.predicted_done += step;
    entry.share = share;
}

void Plan::advanced(const campaign::Attempt& attempt, double share) {
    Entry* entry = running(attempt);
    if (entry == nullptr || !(share >= 0 && share <= 1)) return;
    const bool first = !entry->share;
    move_on(*entry, share);
    if (first) tally_.predicted_done -= share * entry->predicted;
}

Plan::Entry* Plan::running(const campaign::Attempt& attempt) {
    const auto found = index_.find(attempt.case_id);
    if (found == index_.end()) return nullptr;
    Entry& entry = entries_[found->second];
    return entry.running && entry.attempts == attempt.number ? &entry : nullptr;
}

Plan::Verdict Plan::ended(const campaign::Attempt& attempt, Outcome outcome) {
    Entry* found = running(attempt);
    if (found == nullptr) return Verdict::stale;
    Entry& entry = *found;
    entry.running = false;
    --running_;
    if (settles(outcome)) {
        ++(good(outcome) ? tally_.settled_now : tally_.failed_now);
        move_on(entry, 1);
        decide(entry, outcome);
        return Verdict::settled;
    }
    const bool given_up = outcome == Outcome::abandoned ? comes_no_further(entry) : ++entry.failures >= rules_.attempts;
    if (given_up) {
        ++tally_.failed_now;
        move_on(entry, 1);
        decide(entry, outcome);
        return Verdict::gave_up;
    }
    put_back(entry);
    return Verdict::again;
}

Plan::Verdict Plan::given_back(const campaign::Attempt& attempt) {
    return ended(attempt, Outcome::abandoned);
}

bool Plan::comes_no_further(const Entry& entry) {
    auto& known = give_backs_[static_cast<std::size_t>(&entry - entries_.data())];
    const double share = entry.share.value_or(0);
    if (share > known.furthest + headway) known = {0, share};
    return ++known.in_a_row >= rules_.give_backs;
}

void Plan::put_back(Entry& entry) {
    tally_.predicted_left += entry.share.value_or(0) * entry.predicted;  // until the next attempt says what it found
    entry.share.reset();
    queue_.push_front(static_cast<std::size_t>(&entry - entries_.data()));
}

void Plan::never_begun(const campaign::Attempt& attempt) {
    Entry* entry = running(attempt);
    if (entry == nullptr) return;
    entry->running = false;
    --running_;
    put_back(*entry);
    --entry->attempts;
}

std::size_t Plan::settled_prefix() {
    while (prefix_ < places_.size() && entries_[places_[prefix_]].decided) ++prefix_;
    return prefix_;
}

void Plan::decide(Entry& entry, Outcome outcome) {
    entry.decided = true;
    ++tally_.decided;
    if (!good(outcome)) ++tally_.failed;
}

}  // namespace grainsweep::schedule
