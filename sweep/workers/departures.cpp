#include "sweep/workers/departures.hpp"

#include "sweep/workers/child.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <utility>

namespace grainsweep::workers {

namespace {

using namespace std::chrono_literals;

// Seconds.
constexpr double grace_before_kill = 2;
constexpr double place_kept = 5;
constexpr auto time_to_end = 5s;  // of a worker without work, and of its launcher

}  // namespace

void Departures::hurry(std::shared_ptr<Process> child, bool launched, double now) {
    leaving_.push_back({std::move(child), now, now, launched ? now + grace_before_kill : now});
    escalate(leaving_.back(), now);
}

void Departures::let_go(std::shared_ptr<Process> child, double now) {
    leaving_.push_back({std::move(child), now, now + grace_before_kill, now + 2 * grace_before_kill});
}

void Departures::escalate(One& one, double now) {
    if (now >= one.kill_at && !std::exchange(one.killed, true)) return one.child->signal(SIGKILL);
    if (now >= one.ask_at && !std::exchange(one.asked, true)) one.child->signal(SIGTERM);
}

void Departures::keep_time(double now) {
    std::erase_if(leaving_, [&](One& one) {
        if (!one.child->runs()) return true;
        escalate(one, now);
        return false;
    });
}

std::size_t Departures::places_taken(double now) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(leaving_, [&](const One& one) { return now - one.since < place_kept; }));
}

void Departures::end_all(std::vector<std::shared_ptr<Process>> children) {
    for (const auto& one : leaving_) children.push_back(one.child);
    const auto running = [&] { return std::ranges::any_of(children, [](const auto& child) { return child->runs(); }); };
    constexpr auto grace = std::chrono::milliseconds(static_cast<int>(1000 * grace_before_kill));
    wait_while(running, time_to_end);
    for (const auto& child : children)
        if (child->runs()) child->signal(SIGTERM);
    wait_while(running, grace);
    for (const auto& child : children) child->signal(SIGKILL);  // and whatever is left of its process group
    wait_while(running, grace);
    for (const auto& child : children) child->close();
    leaving_.clear();
}

}  // namespace grainsweep::workers
