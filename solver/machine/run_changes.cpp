// What a phase begins with: walls that come, go and start anew, particles taken away and filled; and the start that
// cases share.
#include "solver/machine/run.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>

namespace grainsweep::machine {

constexpr double pressed = 0.01;  // of a radius: how far a particle stands in a wall that it is pressed against

/// Of all that determines the state at the end of a start of one phase: the state at its beginning, with laws, walls
/// and time step, and how long it lasts.
std::string Run::key_of_start() const {
    Bytes bytes;
    engine_->save(bytes);
    ByteWriter out(bytes);
    out.put(spec_.gravity), out.put(spec_.domain.low), out.put(spec_.domain.high);
    out.put(steps_in(spec_.phases.front().duration));
    while (bytes.size() % sizeof(std::uint64_t) != 0) bytes.push_back(std::byte{});
    std::uint64_t one = 1, other = 2;
    for (std::size_t at = 0; at < bytes.size(); at += sizeof one) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, sizeof word);
        one = stats::splitmix64(one ^ word), other = stats::splitmix64(other + word);
    }
    return "machine: start\npath=" + std::string(instruction_path()) + "\nstate=" + std::to_string(one) + " " +
           std::to_string(other) + "\n";
}

void Run::take_start(const dem::Setup& setup) {
    start_key_ = key_of_start();
    const auto stored = artefacts_->get(start_key_);
    if (!stored) return;
    try {
        engine_->restore(*stored);
    } catch (const std::invalid_argument&) {  // of another build, or damaged
        engine_ = dem::make_engine(setup, spec_.method);
        engine_->change_walls(walls_in(spec_, 0, times_));
        return;
    }
    borrowed_particle_steps_ = engine_->work().particle_steps;
    step_ += phase_steps();
    end_phase(0);
}

void Run::store_start() const {
    if (start_key_.empty() || borrowed_particle_steps_ > 0) return;
    Bytes state;
    engine_->save(state);
    artefacts_->put(start_key_, state);
}

void Run::change_walls() {
    const auto walls = walls_in(spec_, phase_, times_, wall_zero_);
    auto without = walls;  // a wall that jumps begins without contacts
    for (std::size_t w = 0; w < walls.size(); ++w)
        without[w].present = walls[w].present && !spec_.walls[w].starts_anew(phase_);
    if (std::ranges::equal(walls, without, {}, &dem::Wall::present, &dem::Wall::present))
        return engine_->change_walls(walls);
    for (std::size_t w = 0; w < walls.size(); ++w)
        if (!without[w].present) without[w].motions = engine_->wall(w).motions;
    engine_->change_walls(without);
    engine_->change_walls(walls);
}

void Run::take_away() {
    std::set<std::int32_t> ids;
    for (const Removal& removal : spec_.removals) {
        if (removal.at != phase_) continue;
        const Frame frame = look(Contacts::none);
        const bool part = removal.of == Removal::Of::part, centre = removal.of == Removal::Of::centre;
        const dem::State& state = centre ? frame.state : frame.spheres();  // of a clump its spheres lie in the region
        std::set<std::int32_t> within, without;
        for (std::size_t i = 0; i < state.id.size(); ++i) {
            if (state.mobile[i] == 0) continue;
            const double least = centre ? 0 : part ? -(1 - pressed) * state.radius[i] : state.radius[i];
            (removal.in.depth(state.position[i]) >= least ? within : without).insert(frame.particle_of(state.id[i]));
        }
        for (const std::int32_t id : within)
            if (part || !without.contains(id)) ids.insert(id);
    }
    if (ids.empty()) return;
    engine_->remove(std::vector<std::int32_t>(ids.begin(), ids.end()));
    taken_ += static_cast<std::int64_t>(ids.size());
    seen_at_.reset();
}

void Run::fill_again() {
    const auto here = [this](const Fill& fill) { return fill.at == phase_; };
    if (phase_ == 0 || std::ranges::none_of(of_kind<Fill>(spec_.fills), here)) return;
    const Frame frame = look(Contacts::none);
    try {
        newest_ = species_.size();
        bed_.position.clear(), bed_.velocity.clear(), bed_.radius.clear();
        for (std::size_t i = 0; i < frame.size(); ++i) {
            if (frame.state.mobile[i] == 0) continue;
            bed_.position.push_back(frame.state.position[i]);
            bed_.velocity.push_back(frame.state.velocity[i]);
            bed_.radius.push_back(frame.state.radius[i]);
        }
        add(filled_later(spec_, seed_, phase_, frame.spheres(), walls_now(), engine_->wall_time()));
    } catch (const std::invalid_argument& why) {
        fault_ = why.what();
    }
}

void Run::move_regions(double wall_time) {
    for (const Follower& follower : followers_)
        *follower.way = way_of(engine_->wall(follower.wall), follower.along, wall_time);
}

}  // namespace grainsweep::machine
