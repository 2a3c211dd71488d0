#include "sweep/spool/task.hpp"

#include "sweep/campaign/overloaded.hpp"
#include "sweep/files/system_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

namespace grainsweep::spool {
namespace {

using campaign::Outcome;
using campaign::Overloaded;
using campaign::unanswered;
using schedule::Ending;
using namespace std::chrono_literals;

// A case that came back so often in one task is left to others.
constexpr std::int64_t most_given_back = 10;
// Times in a row that a file is there and cannot be opened, before the case is looked at later.
constexpr int most_vanished = 3;

double running_time() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::vector<std::uint32_t> order_of(const std::vector<double>& predicted, const Share& share) {
    std::vector<std::uint32_t> by_length(predicted.size());
    std::iota(by_length.begin(), by_length.end(), 0U);
    std::ranges::stable_sort(by_length, std::ranges::greater{}, [&](std::uint32_t i) { return predicted[i]; });
    // Share after share, beginning with its own: tasks that have done theirs do not all go the same way.
    std::vector<std::uint32_t> order;
    order.reserve(predicted.size());
    const auto parts = static_cast<std::size_t>(share.of);
    for (std::size_t k = 0; k < parts; ++k) {
        for (std::size_t i = (static_cast<std::size_t>(share.part) - 1 + k) % parts; i < by_length.size(); i += parts)
            order.push_back(by_length[i]);
    }
    return order;
}

Task::Task(const Spool& spool, campaign::Cases cases, const std::vector<double>& predicted, workers::WorkerPool& crew,
           TaskRules rules, Watchers watchers)
    : spool_(spool),
      cases_(std::move(cases)),
      predicted_(predicted),
      crew_(crew),
      rules_(std::move(rules)),
      watchers_(std::move(watchers)),
      file_(spool, rules_.lease) {
    for (const auto place : order_of(predicted_, rules_.share))
        if (cases_.is_first(place)) open_.push_back(place);
    tally_.cases = open_.size();
}

Ending Task::run() {
    while (!at_once_) {
        file_.keep_young(running_time());
        look_at_time();
        if (!closed_) {
            hand_out();
            look_elsewhere();
        }
        crew_.share_cores(closed_ ? 0 : open_.size(), [this](const campaign::Attempt& one) {
            const auto found = running_.find(one.case_id);
            return found == running_.end() ? 0 : predicted_[found->second.place];
        });
        if (running_.empty() && (closed_ || (open_.empty() && (elsewhere_.empty() || !waits_)))) break;
        if (auto event = crew_.wait(200ms)) handle(std::move(*event));
        watchers_.progress(tally_);
    }
    if (at_once_)
        crew_.dismiss();
    else
        crew_.retire();
    for (const auto& [id, one] : running_)  // ended with the crew
        spool_.answer(
            {unanswered({id, known_[one.place].next}, Outcome::abandoned, "its task was ended", 0), one.computer});
    tally_.elsewhere = elsewhere_.size();
    watchers_.progress(tally_);
    if (broken_) throw SystemError(*broken_);
    return ending();
}

Ending Task::ending() const {
    if (tally_.answered == tally_.cases) return Ending::finished;
    if (early_) return *early_;
    if (tally_.left_out > 0) {
        const bool hopeless = !rules_.walltime.cases_go_on && tally_.shortest_left_out > rules_.walltime.whole;
        return hopeless ? Ending::too_long : Ending::out_of_time;
    }
    return Ending::limited;
}

void Task::look_at_time() {
    if (!rules_.walltime.left || closed_) return;
    const double left = rules_.walltime.left();
    if (left <= 0) {
        closed_ = true;
        early_ = Ending::out_of_time;
        crew_.retire();
        return;
    }
    if (rules_.walltime.cases_go_on && left >= rules_.walltime.shortest_part) return;
    std::erase_if(open_, [&](std::uint32_t place) {
        const double predicted = predicted_[place];
        if (!(predicted > left)) return false;
        tally_.shortest_left_out = tally_.left_out++ == 0 ? predicted : std::min(tally_.shortest_left_out, predicted);
        return true;
    });
}

void Task::hand_out() {
    crew_.expect(open_.size());
    while (!open_.empty()) {
        const std::uint32_t place = open_.front();
        const auto where = crew_.place_for(predicted_[place]);
        if (!where) return;
        open_.pop_front();
        if (!claims(place)) continue;
        auto question = cases_.question(place);
        const campaign::Attempt attempt{question.id, known_[place].next};
        running_.insert_or_assign(question.id, Running{place, *where->computer});
        crew_.give(*where, attempt, question);
    }
}

bool Task::claims(std::uint32_t place) {
    const auto taken = take(place);
    if (taken == Taken::elsewhere) elsewhere_.push_back(place);
    return taken == Taken::claimed;
}

Task::Taken Task::take(std::uint32_t place) {
    auto& known = known_[place];
    const auto id = cases_.id(place);
    for (int vanished = 0;;) {
        const campaign::Attempt attempt{id, known.next};
        if (spool_.claim(attempt, file_.name())) return Taken::claimed;
        const auto entry = spool_.read(attempt);
        if (!entry) {
            // It was released in between, or this node does not see it yet.
            if (++vanished == most_vanished) return Taken::elsewhere;
            continue;
        }
        if (const auto* claim = std::get_if<Claim>(&*entry); claim != nullptr && is_alive(attempt, *claim))
            return Taken::elsewhere;
        if (pass_over(place, attempt, *entry)) return Taken::over;
    }
}

bool Task::is_alive(const campaign::Attempt& attempt, const Claim& claim) {
    if (claim.task.empty()) return !file_.is_abandoned(attempt);
    return file_.state_of(claim.task) != TaskFile::State::dead;
}

/// Handles an ended attempt. Returns whether the case needs no other one.
bool Task::pass_over(std::uint32_t place, const campaign::Attempt& attempt, const Entry& entry) {
    auto& known = known_[place];
    ++known.next;
    if (const auto* damaged = std::get_if<Damaged>(&entry)) {
        watchers_.note(
            fmt::format("{}.{}: {}; computing the case again", attempt.case_id, attempt.number, damaged->why));
        return false;
    }
    const auto* answer = std::get_if<Answer>(&entry);
    if (answer == nullptr) return false;  // its task is dead
    const auto outcome = answer->result.outcome;
    const bool failed = outcome == Outcome::crashed || outcome == Outcome::timed_out;
    if (failed) ++known.failures;
    if (!settles(outcome) && (!failed || known.failures < rules_.attempts)) return false;
    settle(outcome);
    return true;
}

void Task::settle(Outcome outcome) {
    ++tally_.answered;
    if (outcome != Outcome::completed && outcome != Outcome::skipped) ++tally_.failed;
}

/// Looks for cases of other tasks that are answered or free, when this task has no case of its own to begin.
void Task::look_elsewhere() {
    const double now = running_time();
    if (!open_.empty() || elsewhere_.empty() || !waits_) return;
    if (now - looked_elsewhere_ < std::min(rules_.lease / 10, 5.0)) return;
    looked_elsewhere_ = now;
    bool all_renewed = true;
    const auto looked_at = std::exchange(elsewhere_, {});
    for (const auto place : looked_at) {
        const campaign::Attempt attempt{cases_.id(place), known_[place].next};
        const auto entry = spool_.read(attempt);
        const auto* claim = entry ? std::get_if<Claim>(&*entry) : nullptr;
        if (claim != nullptr && is_alive(attempt, *claim)) {
            elsewhere_.push_back(place);
            if (claim->task.empty() || file_.state_of(claim->task) != TaskFile::State::renewed) all_renewed = false;
        } else {
            open_.push_back(place);
        }
    }
    // Living tasks finish their own cases; waiting for them would keep a node idle.
    if (open_.empty() && all_renewed && running_.empty()) waits_ = false;
}

void Task::handle(workers::PoolEvent event) {
    std::visit(Overloaded{[&](workers::Finished& finished) {
                              finish(finished.result);
                              if (finished.checkpointed && settles(finished.result.outcome))
                                  watchers_.forget_checkpoint(finished.result.attempt.case_id);
                          },
                          [&](const workers::Heartbeat&) {},
                          [&](const workers::Lost& lost) {
                              if (lost.running && lost.from_outside)
                                  give_back(*lost.running, lost.reason, lost.seconds, false);
                              else if (lost.running)
                                  fail(*lost.running, Outcome::crashed, lost.reason, lost.seconds);
                              if (lost.running && lost.spoils_checkpoint && !lost.from_outside)
                                  watchers_.forget_checkpoint(lost.running->case_id);
                              never_begun(lost.queued);
                          },
                          [&](const workers::TimedOut& late) {
                              fail(late.running, Outcome::timed_out, late.reason, late.seconds);
                              never_begun(late.queued);
                          },
                          [&](const workers::GivenBack& back) {
                              if (back.broken && !broken_) {
                                  broken_ = back.reason;
                                  closed_ = true;
                                  crew_.retire();
                              }
                              give_back(back.attempt, back.reason, back.seconds, back.asked || back.broken);
                          },
                          [&](const workers::Remark& remark) { watchers_.note(remark.text); },
                          [&](const workers::Interrupted& stop) {
                              closed_ = true;
                              if (!early_) early_ = stop.goes_on ? Ending::asked_to_end : Ending::interrupted;
                              crew_.retire();
                              at_once_ = stop.at_once;
                          }},
               event);
}

void Task::finish(const campaign::CaseResult& result) {
    if (!settles(result.outcome)) return fail(result.attempt, result.outcome, result.message, result.cost.wall_seconds);
    const auto found = running_.find(result.attempt.case_id);
    spool_.answer({result, found->second.computer});
    running_.erase(found);
    ++tally_.computed;
    settle(result.outcome);
    if (result.outcome == Outcome::unstable || result.outcome == Outcome::rejected)
        watchers_.note(
            fmt::format("{} {}: {}", result.attempt.case_id.substr(0, 12), to_string(result.outcome), result.message));
}

void Task::fail(const campaign::Attempt& attempt, Outcome outcome, const std::string& reason, double seconds) {
    const auto found = running_.find(attempt.case_id);
    const auto one = found->second;
    running_.erase(found);
    spool_.answer({unanswered(attempt, outcome, reason, seconds), one.computer});
    auto& known = known_[one.place];
    ++known.next;
    const bool again = ++known.failures < rules_.attempts;
    watchers_.note(fmt::format("{} {} in attempt {}{}: {}", attempt.case_id.substr(0, 12), to_string(outcome),
                               attempt.number, again ? ", trying again" : ", giving up", reason));
    if (again)
        open_.push_front(one.place);
    else
        settle(outcome);
}

void Task::give_back(const campaign::Attempt& attempt, const std::string& reason, double seconds, bool asked) {
    const auto found = running_.find(attempt.case_id);
    const auto one = found->second;
    running_.erase(found);
    // A file of its own for every attempt that was begun: the next one looks for a checkpoint.
    spool_.answer({unanswered(attempt, Outcome::abandoned, reason, seconds), one.computer});
    auto& known = known_[one.place];
    ++known.next;
    const bool again = ++known.given_back < most_given_back;
    if (!asked)
        watchers_.note(fmt::format("{} given back in attempt {}{}: {}", attempt.case_id.substr(0, 12), attempt.number,
                                   again ? ", trying again" : ", left to other tasks", reason));
    if (again) open_.push_front(one.place);
}

void Task::never_begun(const std::vector<campaign::Attempt>& attempts) {
    for (const auto& attempt : attempts) {
        const auto found = running_.find(attempt.case_id);
        open_.push_front(found->second.place);
        running_.erase(found);
        spool_.release(attempt);
    }
}

}  // namespace grainsweep::spool
