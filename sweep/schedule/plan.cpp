#include "sweep/schedule/plan.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <utility>

namespace grainsweep::schedule {
namespace {

using campaign::Outcome;

// The end of a run begins when the remaining work, shared by all workers, takes this many times the longest remaining
// case. At 1 all other cases would end together with the longest one; 2 allows for predictions that are wrong by a
// factor of 2.
constexpr double longest_cases_left = 2;

// Less than this is no headway: a case that is given back must have come further than the last time.
constexpr double headway = 0.01;

bool good(Outcome outcome) {
    return outcome == Outcome::completed || outcome == Outcome::skipped;
}

/// Returns a reason without what differs from case to case: words with digits, such as numbers, ids and addresses. The
/// status of an exit stays.
std::string without_numbers(std::string_view reason) {
    const auto is_sign = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '+' || c == '-';
    };
    std::string plain;
    while (!reason.empty()) {
        const auto end = static_cast<std::size_t>(std::ranges::find_if_not(reason, is_sign) - reason.begin());
        const auto word = reason.substr(0, end);
        const bool is_status = plain.ends_with("exit code ") || plain.ends_with("signal ");
        plain += is_status || word.find_first_of("0123456789") == std::string_view::npos ? word : "#";
        if (end < reason.size()) plain += reason[end];
        reason.remove_prefix(std::min(end + 1, reason.size()));
    }
    return plain;
}

/// Returns the first and the last line of a text, shortened.
std::string in_one_line(std::string_view text) {
    constexpr std::size_t longest = 240;
    const auto shortened = [](std::string_view line) {
        return line.size() <= longest ? std::string(line) : std::string(line.substr(0, longest)) + "...";
    };
    while (text.ends_with('\n')) text.remove_suffix(1);
    const auto first = std::min(text.find('\n'), text.size());
    const auto last = text.rfind('\n');
    return last == std::string_view::npos
               ? shortened(text)
               : shortened(text.substr(0, first)) + " ... " + shortened(text.substr(last + 1));
}

}  // namespace

Plan::Plan(Questions questions, const Rules& rules)
    : ask_(std::move(questions.ask)), places_(std::move(questions.places)), rules_(rules) {
    const auto& histories = questions.histories;
    assert(histories.size() == questions.predicted.size());
    assert(questions.blocks.empty() || questions.blocks.size() == histories.size());
    entries_.reserve(histories.size());
    decided_.resize(histories.size());
    queue_.reserve(histories.size());
    const bool anew = failed_before(histories);
    for (std::size_t i = 0; i < histories.size(); ++i) {
        Entry entry{questions.predicted[i], histories[i].attempts, histories[i].failures};
        const auto& known = histories[i].outcome;
        if (known && good(*known)) may_be_alike_ = false;
        const bool asked_again = known && (rules_.again == known || anew);
        if (anew && histories[i].asked && (entry.failures >= rules_.attempts || (known && settles(*known))))
            ++tried_again_;
        if (asked_again) entry.failures = 0;
        const bool exhausted = entry.failures >= rules_.attempts;
        const bool decided = known && !asked_again && (settles(*known) || exhausted);
        if (!histories[i].asked) {
            decided_[i] = decided;
        } else if (++tally_.questions; decided) {
            decide(i, *known);
        } else {
            queue_.push_back(static_cast<std::uint32_t>(i));
        }
        entries_.push_back(entry);
    }
    order_the_end(questions.blocks);
}

bool Plan::failed_before(std::span<const History> histories) const {
    std::size_t failed = 0, open = 0;
    for (const auto& one : histories) {
        if (one.outcome && good(*one.outcome)) return false;
        if (one.outcome && (settles(*one.outcome) || one.failures >= rules_.attempts))
            ++failed;
        else if (one.asked)
            ++open;
    }
    return rules_.stop_after_alike && failed >= *rules_.stop_after_alike && open > 0;
}

void Plan::order_the_end(std::span<const std::uint32_t> blocks) {
    const std::size_t end =
        rules_.max_cases ? std::min(static_cast<std::size_t>(*rules_.max_cases), queue_.size()) : queue_.size();
    const auto length = [this](std::uint32_t question) { return entries_[question].predicted; };
    const auto block = [&](std::uint32_t question) { return blocks.empty() ? 0 : blocks[question]; };
    const std::vector<std::uint32_t> in_order(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(end));
    double left = 0;
    for (const auto question : in_order) left += length(question);
    tally_.predicted_waiting = left;

    // Longest first, of equally long ones the first, block by block.
    std::vector<std::uint32_t> by_length = in_order;
    std::ranges::stable_sort(by_length, [&](std::uint32_t a, std::uint32_t b) {
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
        const auto next = near_the_end ? *longest : *first;
        queue_[at] = next;
        taken[next] = true;
        left -= length(next);
    }
}

std::optional<double> Plan::next_predicted() const {
    if (closed_ || queue_is_empty()) return std::nullopt;
    if (rules_.max_cases && std::cmp_greater_equal(begun(), *rules_.max_cases)) return std::nullopt;
    if (too_many_failures() || failed_alike()) return std::nullopt;
    return entries_[front()].predicted;
}

std::size_t Plan::waiting() const {
    if (!next_predicted()) return 0;
    return rules_.max_cases ? std::min(queued(), static_cast<std::size_t>(*rules_.max_cases) - begun()) : queued();
}

std::optional<std::vector<double>> Plan::last_predicted(std::size_t most) const {
    const std::size_t count = waiting();
    if (count > most) return std::nullopt;
    std::vector<double> seconds;
    for (std::size_t k = 0; k < count; ++k) {
        const auto question =
            k < returned_.size() ? returned_[returned_.size() - 1 - k] : queue_[head_ + k - returned_.size()];
        seconds.push_back(entries_[question].predicted);
    }
    return seconds;
}

std::optional<Plan::Start> Plan::next() {
    if (!next_predicted()) return std::nullopt;
    const std::uint32_t question = front();
    if (returned_.empty())
        ++head_;
    else
        returned_.pop_back();
    Entry& entry = entries_[question];
    tally_.predicted_waiting -= entry.predicted;
    ++entry.attempts;
    Start start{{}, ask_(question), entry.predicted};
    start.attempt = {start.question.id, entry.attempts};
    under_way_.insert_or_assign(start.question.id, Running{question, entry.attempts, {}});
    return start;
}

void Plan::advanced(const campaign::Attempt& attempt, double share) {
    const auto found = find(attempt);
    if (found != under_way_.end() && share >= 0 && share <= 1) found->second.share = share;
}

double Plan::predicted(const campaign::Attempt& attempt) const {
    const auto found = under_way_.find(attempt.case_id);
    if (found == under_way_.end() || found->second.number != attempt.number) return 0;
    return entries_[found->second.question].predicted;
}

double Plan::seconds_left(const campaign::Attempt& attempt) const {
    const auto found = under_way_.find(attempt.case_id);
    return found == under_way_.end() ? 0 : predicted(attempt) * (1 - found->second.share.value_or(0));
}

Plan::UnderWay::iterator Plan::find(const campaign::Attempt& attempt) {
    const auto found = under_way_.find(attempt.case_id);
    return found != under_way_.end() && found->second.number == attempt.number ? found : under_way_.end();
}

void Plan::compare_failure(Outcome outcome, std::string_view reason) {
    if (!rules_.stop_after_alike || !may_be_alike_ || failed_alike()) return;
    auto plain = std::string(campaign::to_string(outcome)) + ": " + without_numbers(reason);
    if (alike_++ == 0) {
        tally_.failed_alike = std::string(campaign::to_string(outcome)) + ": " + in_one_line(reason);
        first_failure_ = std::move(plain);
    } else if (plain != first_failure_) {
        may_be_alike_ = false;
    }
}

Plan::Verdict Plan::ended(const campaign::Attempt& attempt, Outcome outcome, std::string_view reason) {
    const auto found = find(attempt);
    if (found == under_way_.end()) return Verdict::stale;
    const Running one = found->second;
    under_way_.erase(found);
    Entry& entry = entries_[one.question];
    if (settles(outcome)) {
        ++(good(outcome) ? tally_.settled_now : tally_.failed_now);
        if (good(outcome))
            may_be_alike_ = false;
        else
            compare_failure(outcome, reason);
        decide(one.question, outcome);
        return Verdict::settled;
    }
    const bool given_up = outcome == Outcome::abandoned ? comes_no_further(one) : ++entry.failures >= rules_.attempts;
    if (given_up) {
        ++tally_.failed_now;
        compare_failure(outcome, reason);
        decide(one.question, outcome);
        return Verdict::gave_up;
    }
    put_back(one);
    return Verdict::again;
}

Plan::Verdict Plan::given_back(const campaign::Attempt& attempt) {
    return ended(attempt, Outcome::abandoned);
}

bool Plan::comes_no_further(const Running& one) {
    auto& known = give_backs_[one.question];
    const double share = one.share.value_or(0);
    if (share > known.furthest + headway) known = {0, share};
    return ++known.in_a_row >= rules_.give_backs;
}

void Plan::put_back(const Running& one) {
    tally_.predicted_waiting += entries_[one.question].predicted;
    returned_.push_back(one.question);
}

void Plan::never_begun(const campaign::Attempt& attempt) {
    const auto found = find(attempt);
    if (found == under_way_.end()) return;
    const Running one = found->second;
    under_way_.erase(found);
    put_back(one);
    --entries_[one.question].attempts;
}

void Plan::leave_out_longer_than(double seconds) {
    const auto too_long = [&](std::uint32_t question) {
        const double predicted = entries_[question].predicted;
        if (!(predicted > seconds)) return false;
        tally_.predicted_waiting -= predicted;
        shortest_left_out_ = left_out_++ == 0 ? predicted : std::min(shortest_left_out_, predicted);
        return true;
    };
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(std::exchange(head_, 0)));
    std::erase_if(queue_, too_long);
    std::erase_if(returned_, too_long);
}

std::size_t Plan::settled_prefix() {
    while (prefix_ < placed() && decided_[question_at(prefix_)]) ++prefix_;
    return prefix_;
}

void Plan::decide(std::size_t question, Outcome outcome) {
    decided_[question] = true;
    ++tally_.decided;
    if (!good(outcome)) ++tally_.failed;
}

}  // namespace grainsweep::schedule
