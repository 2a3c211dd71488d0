#include "solver/machine/run.hpp"

#include "solver/machine/drawing.hpp"
#include "solver/machine/frames.hpp"
#include "solver/machine/plan.hpp"
#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grainsweep::machine {
namespace {

using geometry::dot;
using geometry::norm;
using geometry::operator*;

constexpr std::uint64_t start_stream = std::uint64_t{1} << 41U;        // behind those of fillings
constexpr std::uint64_t checkpoint_format = 0x6772'6e73'6d63'0008ULL;  // "grnsmc", version 8
constexpr std::int64_t most_steps = 1'000'000'000'000'000;             // of a phase
constexpr double calm = 1e-3;                                          // kinetic energy of a particle at rest, in m g d
constexpr double checks = 0.25;                                        // interval of checks, in sqrt(d/g)
constexpr double longest_check = 0.01;                                 // of the phase, without gravity

double mean_diameter(const Spec& spec) {
    double sum = 0;
    for (const Species& species : spec.species) sum += species.diameter / static_cast<double>(spec.species.size());
    return sum;
}

/// sqrt(d/g), s; infinite without gravity.
double falling_time(const Spec& spec) {
    return std::sqrt(mean_diameter(spec) / norm(spec.gravity));
}

/// Whole steps of the time between two frames of a phase.
std::int64_t every_steps(double every, double step) {
    return std::max<std::int64_t>(1, std::llround(std::min(std::floor(every / step), 1e15)));
}

/// Spheres that feeds and later fillings may add.
std::vector<dem::ToCome> to_come_of(const Spec& spec) {
    std::vector<const Mix*> mixes;
    for (const Feed& feed : spec.feeds) mixes.push_back(&feed.mix);
    for (const Fill& fill : of_kind<Fill>(spec.fills))
        if (fill.at > 0) mixes.push_back(&fill.mix);
    std::vector<dem::ToCome> all;
    for (const Mix* mix : mixes)
        for (const auto& [number, share] : *mix) {
            const Species& species = spec.species[number];
            const auto announce = [&](double radius) {  // divided by the diameter
                all.push_back({species.smallest() * radius, species.largest() * radius, species.material});
            };
            if (!species.shape) announce(0.5);
            for (std::size_t k = 0; species.shape && k < species.shape->balls.size(); ++k)
                announce(species.shape->balls[k].radius);
        }
    return all;
}

/// Runs at most to a stop, or to the first step that is not before `until`, both in steps from here; at least one step.
/// Returns the number of completed steps: an unsound state ends the run early. The slices do not change the stops.
std::int64_t run_towards(dem::Engine& engine, std::int64_t stop, double until) {
    const double left = std::ceil(until);
    const std::int64_t before = engine.work().steps;
    engine.run(left < static_cast<double>(stop) ? std::max<std::int64_t>(1, std::llround(left)) : stop);
    return engine.work().steps - before;
}

}  // namespace

Run::Run(Spec spec, std::uint64_t seed, Artefacts* artefacts)
    : spec_(std::move(spec)),
      seed_(spec_.start.seed ? stats::bits_at(0, start_stream, static_cast<std::uint64_t>(*spec_.start.seed)) : seed),
      artefacts_(artefacts),
      records_(spec_.measures.size()) {
    for (const MachineWall& wall : spec_.walls)
        has_free_walls_ = has_free_walls_ || std::ranges::any_of(wall.motions, [](const WallMotion& motion) {
                              return std::holds_alternative<geometry::Flight>(motion.motion);
                          });
    for (std::size_t w = 0; w < spec_.walls.size(); ++w)
        if (const Vec3 most = spec_.walls[w].scattered; norm(most) > 0)  // before the start it moves to its place
            spec_.walls[w].motions.push_back(
                {geometry::Translation{stats::to_unit(stats::bits_at(seed, start_stream, w)) * most, -1, 0}, {}});
    const auto follow = [this](Region& region) {
        region.each_moving([this](Region::Moving& moving) {
            followers_.push_back({moving.wall, moving.along, std::make_shared<Vec3>()});
            moving.moved = followers_.back().way;
        });
    };
    for (Fill& fill : of_kind<Fill>(spec_.fills)) follow(fill.in);
    for (Feed& feed : spec_.feeds) follow(feed.through);
    each_region(spec_, follow);
    const auto walls = walls_in(spec_, 0, {.begin = {0}, .end = {}});  // fillings are made before the engine
    for (const Follower& follower : followers_) *follower.way = way_of(walls[follower.wall], follower.along, 0);
    const Filled start = filled(spec_, seed_, artefacts);
    counts_ = start.counts;
    for (Phase& phase : spec_.phases)
        if (phase.every) phase.frames = (steps_in(phase.duration) - 1) / every_steps(*phase.every, spec_.time_step) + 1;
    for (const Cut& cut : of_kind<Cut>(spec_.fills))
        if (cut.tight) tight_ = std::min(*cut.tight, tight_.value_or(*cut.tight));
    dem::Setup setup = setup_of(spec_, start);
    setup.to_come = to_come_of(spec_);
    named_ = start.named;
    enlist(start);
    for (const Measure& measure : spec_.measures) {
        const ProbeInfo& probe = *find_probe(measure.probe);
        probes_.push_back(probe.make(measure.options));
        needs_contacts_ = needs_contacts_ || probe.contacts;
        first_plane_.push_back(setup.counting.size());
        std::ranges::copy(probes_.back()->planes(), std::back_inserter(setup.counting));
    }
    first_plane_.push_back(setup.counting.size());
    engine_ = dem::make_engine(setup, spec_.method);
    for (const Phase& phase : spec_.phases) {
        scattered_.push_back(!phase.frames_given && in_step(spec_, scattered_.size()));
        auto& watching = watching_.emplace_back();
        auto& at_steps = at_steps_.emplace_back();
        const auto attend = [&](const Measure& measure, Probe& probe) {
            if (find_probe(measure.probe)->source == Source::steps) at_steps.push_back(&probe);
        };
        for (std::size_t m = 0; m < probes_.size(); ++m)
            if (holds(spec_.measures[m].during, at_steps_.size() - 1)) attend(spec_.measures[m], *probes_[m]);
        for (const Until& until : phase.until) {
            const auto* passes = std::get_if<Passes>(&until);
            const Measure* measure = passes != nullptr ? &spec_.measures[passes->measure] : nullptr;
            watching.push_back(measure != nullptr ? find_probe(measure->probe)->make(measure->options) : nullptr);
            if (measure != nullptr) attend(*measure, *watching.back());
        }
    }
    glued_ = std::ranges::count(start.spheres, false, &dem::Sphere::mobile);
    for (std::size_t k = 0; k < spec_.feeds.size(); ++k) {
        feeders_.emplace_back(spec_, k, seed);
        feeders_.back().require_room();
    }
    begin_phase();
    // Of several phases the state at the end does not tell all: walls come and go, and each has its deepest overlap.
    if (spec_.start.seed && artefacts_ != nullptr && spec_.start.phases == 1) take_start(setup);
}

std::int64_t Run::steps_in(double seconds) const {
    const double steps = std::ceil(seconds / spec_.time_step - 1e-6);
    return std::llround(std::clamp(steps, 1.0, static_cast<double>(most_steps)));
}

std::int64_t Run::step_of_frame(std::int64_t frame) const {
    if (const auto every = phase().every)
        return phase_begin_ + std::min(frame * every_steps(*every, spec_.time_step), phase_steps());
    const double share = share_of_frame(frame, phase().frames, scattered_[phase_]);
    return phase_begin_ + std::llround(share * static_cast<double>(phase_steps()));
}

/// Steps between two checks whether the phase ends early.
static std::int64_t check_steps(const Spec& spec, const Phase& phase) {
    const double interval = std::min(checks * falling_time(spec), longest_check * phase.duration);
    return std::max<std::int64_t>(1, std::llround(interval / spec.time_step));
}

std::int64_t Run::next_stop() const {
    if (!at_steps_[phase_].empty()) return step_ + 1;
    std::int64_t stop = phase_begin_ + phase_steps();
    if (frame_ <= phase().frames) stop = std::min(stop, step_of_frame(frame_));
    if (!phase().until.empty() && !phase().ends_at_frames)
        stop = std::min(stop, phase_begin_ + (check_ + 1) * check_steps(spec_, phase()));
    for (const Feed& feed : spec_.feeds)
        if (holds(feed.during, phase_)) {
            const std::int64_t every = steps_in(feed.interval);
            stop = std::min(stop, phase_begin_ + ((step_ - phase_begin_) / every + 1) * every);
        }
    return stop;
}

void Run::advance(double until) {
    while (!finished() && health().stable() && time() < until) {
        const std::int64_t stop = next_stop();
        if (at_steps_[phase_].empty())
            step_ += run_towards(*engine_, stop - step_, until / spec_.time_step - static_cast<double>(step_));
        else
            step_ += run_watched_step();
        give_crossings();
        if (health().stable() && step_ == stop) stop_here();
    }
}

/// Runs a step, part by part, and shows each part to the probes that attend to it. Returns the number of completed
/// steps: 0 after a fault.
std::int64_t Run::run_watched_step() {
    do {
        engine_->run_part();
        if (!health().stable()) return 0;
        Frame frame = look(Contacts::of_step);
        frame.time = spec_.time_step * static_cast<double>(step_ + 1);
        frame.time_step = engine_->part();
        frame.by_partners = partner_order_.of(contacts_);
        for (Probe* probe : at_steps_[phase_]) probe->step(frame);
    } while (!engine_->at_step());
    return 1;
}

/// Gives the passages since the last stop to the probes of the present phase.
void Run::give_crossings() {
    if (first_plane_.back() == 0) return;
    crossings_.clear();
    engine_->take_crossings(crossings_);
    const Frame now = frame();
    for (const dem::Crossing& crossing : crossings_) {
        const auto next = std::ranges::upper_bound(first_plane_, crossing.plane);
        const auto m = static_cast<std::size_t>(next - first_plane_.begin()) - 1;
        const Passage passage{static_cast<std::size_t>(crossing.id), crossing.plane - first_plane_[m], crossing.forward,
                              spec_.time_step * crossing.steps, crossing.position};
        move_regions(engine_->wall_time() - (time() - passage.time));
        if (holds(spec_.measures[m].during, phase_)) probes_[m]->passed(now, passage);
        for (std::size_t k = 0; k < phase().until.size(); ++k)
            if (const auto* passes = std::get_if<Passes>(&phase().until[k]); passes != nullptr && passes->measure == m)
                watching_[phase_][k]->passed(now, passage);
    }
}

void Run::begin_phase() {
    times_.begin.push_back(time());
    phase_begin_ = step_;
    frame_ = check_ = 0;
    calm_since_.assign(phase().until.size(), time());
    watched_.assign(phase().until.size(), undefined);
    peak_overlap_ = peak_overlap();
    peak_wall_overlap_ = peak_wall_overlap();
    engine_->forget_peak_overlap();
    seen_at_.reset();
    take_away();
    if (phase_ > 0 && phase_ == spec_.start.phases) {
        wall_zero_ = time();
        engine_->set_walls(walls_in(spec_, phase_, times_, wall_zero_));
    } else if (phase_ > 0) {
        change_walls();
    }
    seen_at_.reset();
    judge_walls_that_appear();
    if (!health().stable()) return;
    fill_again();
    feed();
    for (std::size_t m = 0; m < probes_.size(); ++m)
        if (spec_.measures[m].repeats != Measure::Repeats::all && holds(spec_.measures[m].during, phase_) &&
            (phase_ == 0 || !holds(spec_.measures[m].during, phase_ - 1)))
            probes_[m]->restart();
    for (std::size_t k = 0; k < watched_.size(); ++k)
        if (const auto* flow = std::get_if<FlowStops>(&phase().until[k])) watched_[k] = mass_in(flow->region);
    take_frame();
}

/// Returns whether a step of a phase can change an answer; a first value is from before its steps.
bool Run::measured(std::size_t phase) const {
    return std::ranges::any_of(spec_.measures,
                               [phase](const Measure& m) { return holds(m.during, phase) && m.reduction != "first"; });
}

void Run::end_phase(std::uint8_t condition) {
    times_.end.push_back(time());
    if (measured(phase_)) {
        judged_overlap_ = std::max(judged_overlap_, engine_->peak_overlap());
        judged_wall_overlap_ = std::max(judged_wall_overlap_, engine_->peak_wall_overlap());
    }
    for (std::size_t k = 0; condition > 0 && k < feeders_.size(); ++k)
        if (holds(spec_.feeds[k].during, phase_))
            feeders_[k].owe(-static_cast<double>(credited_ahead(spec_.feeds[k])) * spec_.time_step);
    ended_by_.push_back(condition);
    if (phase_ + 1 == spec_.start.phases) store_start();
    if (phase_ == 0) lost_first_ = lost();
    ++phase_;
    if (!finished()) begin_phase();
}

void Run::stop_here() {
    if (step_ > phase_begin_) feed();
    const bool framed = frame_ <= phase().frames && step_ == step_of_frame(frame_);
    if (framed) take_frame();
    if (!health().stable()) return;
    const std::uint8_t condition = checks_here(framed) ? ended_by() : std::uint8_t{0};
    if (condition > 0) framed ? look_once_more() : take_frame();
    if (condition > 0 || step_ == phase_begin_ + phase_steps()) end_phase(condition);
}

bool Run::checks_here(bool framed) {
    if (phase().until.empty()) return false;
    if (phase().ends_at_frames) return framed;
    if (step_ != phase_begin_ + (check_ + 1) * check_steps(spec_, phase())) return false;
    ++check_;
    return true;
}

std::int64_t Run::credited_ahead(const Feed& feed) const {
    const std::int64_t every = steps_in(feed.interval), since = step_ - phase_begin_;
    return std::min((since / every + 1) * every, phase_steps()) - since;
}

// Feeds a batch: the mass that is due until the next batch, or until the end of the phase.
void Run::feed() {
    for (std::size_t k = 0; k < feeders_.size(); ++k) {
        if (!holds(spec_.feeds[k].during, phase_)) continue;
        const std::int64_t due = credited_ahead(spec_.feeds[k]);
        if ((step_ - phase_begin_) % steps_in(spec_.feeds[k].interval) != 0 || due == 0) continue;
        feeders_[k].owe(static_cast<double>(due) * spec_.time_step);
        engine_->state(spheres_);
        move_regions(engine_->wall_time());
        add(feeders_[k].batch(spheres_, walls_now(), engine_->wall_time()));
    }
}

std::vector<dem::Wall> Run::walls_now() const {
    std::vector<dem::Wall> walls;
    for (std::size_t w = 0; w < spec_.walls.size(); ++w) walls.push_back(engine_->wall(w));
    return walls;
}

void Run::add(const Filled& added) {
    if (added.spheres.empty()) return;
    engine_->add(added.spheres, added.bodies);
    seen_at_.reset();
    enlist(added);
}

Frame Run::look(Contacts contacts) {
    if (step_ == seen_at_ && (contacts == Contacts::none || contacts == seen_)) return frame();
    seen_at_ = contacts == Contacts::of_step ? std::nullopt : std::optional(step_);
    seen_ = contacts;
    engine_->state(spheres_);
    if (has_clumps()) gather_particles();
    move_regions(engine_->wall_time());
    contacts_.clear();
    if (contacts == Contacts::present) engine_->contacts(contacts_);
    if (contacts == Contacts::of_step) engine_->step_contacts(contacts_);
    return frame();
}

Frame Run::frame() const {
    return {*engine_,
            particles(),
            contacts_,
            species_,
            density_,
            spec_.domain,
            spec_.gravity,
            time(),
            engine_->peak_overlap(),
            radius_,
            spec_.time_step,
            {},
            particle_,
            has_clumps() ? &spheres_ : nullptr,
            named_,
            newest_,
            &bed_};
}

void Run::take_frame() {
    const Frame frame = look(needs_contacts_ ? Contacts::present : Contacts::none);
    for (std::size_t m = 0; m < probes_.size(); ++m) {
        const Measure& measure = spec_.measures[m];
        if (!holds(measure.during, phase_) || phase_ < spec_.start.phases) continue;
        if (frame_ % measure.every != 0 && frame_ < phase().frames && step_ < phase_begin_ + phase_steps()) continue;
        take(m, frame);
    }
    if (fault_.empty()) judge_free_walls();
    if (tight_ && fault_.empty() && peak_overlap() > *tight_)
        fault_ = kit::sentence(
            "two particles overlapped by %.3g of a diameter before %.4g s: more than the %.3g up to which the glued "
            "particles that were left out cannot be touched",
            peak_overlap(), time(), *tight_);
    // Of frames closer than the time step one is taken.
    while (++frame_ <= phase().frames && step_of_frame(frame_) <= step_) continue;
}

/// A phase has ended at this frame: a measurement at few frames that is asked for its last value is taken now.
void Run::look_once_more() {
    const Frame frame = look(needs_contacts_ ? Contacts::present : Contacts::none);
    for (std::size_t m = 0; m < probes_.size(); ++m)
        if (const Measure& measure = spec_.measures[m]; holds(measure.during, phase_) && measure.every > 1 &&
                                                        find_reduction(measure.reduction)->last &&
                                                        records_[m].looked != frame.time)
            take(m, frame);
}

/// Takes a measurement at a frame.
void Run::take(std::size_t m, const Frame& frame) {
    const Measure& measure = spec_.measures[m];
    Record& record = records_[m];
    double value = probes_[m]->look(frame);
    // The end of a phase is the beginning of the next one.
    const double before = std::exchange(record.looked, frame.time);
    if (before == frame.time) return;
    if (is_integrated(measure)) {
        const double integral = probes_[m]->integral(frame), since = std::exchange(record.integral, integral);
        if (frame_ > 0 && std::isfinite(integral))
            record.intervals.push_back({frame.time, frame.time - before, integral - since});
    }
    if (measure.relative && find_probe(measure.probe)->over.empty()) {
        if (record.first.empty()) record.first = {value};
        value /= record.first.front();
    }
    if (std::isfinite(value)) record.samples.push_back({.time = frame.time, .value = value});
    if (find_probe(measure.probe)->over.empty()) return;
    std::vector<Sample> profile;
    probes_[m]->profile(frame, profile);
    add_profile(measure, profile, frame.time, record);
}

void Run::add_profile(const Measure& measure, std::span<const Sample> profile, double time, Record& record) {
    const bool first = measure.relative && record.first.size() != profile.size();
    if (first) record.first.clear();
    record.sums.resize(profile.size(), 0.0), record.counts.resize(profile.size(), 0.0);
    record.bins.resize(profile.size(), 0.0), record.last.assign(profile.size(), undefined);
    for (std::size_t b = 0; b < profile.size(); ++b) {
        record.bins[b] = profile[b].bin;
        if (first) record.first.push_back(profile[b].value);
        const double value = measure.relative ? profile[b].value / record.first[b] : profile[b].value;
        if (!std::isfinite(value)) continue;
        record.last[b] = value;
        record.sums[b] += value;
        record.counts[b] += 1;
        if (find_reduction(measure.reduction)->every && value != 0)
            record.samples.push_back({.time = time, .bin = profile[b].bin, .value = value});
    }
}

double Run::mass_in(const Region& region) {
    const Frame frame = look(Contacts::none);
    double mass = 0;
    const RegionNow here(region);
    for (std::size_t i = 0; i < frame.size(); ++i)
        if (frame.state.mobile[i] != 0 && here.contains(frame.state.position[i])) mass += frame.mass(i);
    return mass;
}

std::uint8_t Run::ended_by() {
    std::uint8_t first = 0;
    // Each of them looks, so that none misses when powder came to rest.
    for (std::size_t k = 0; k < phase().until.size(); ++k)
        if (holds_now(k) && first == 0) first = static_cast<std::uint8_t>(k + 1);
    return first;
}

bool Run::holds_now(std::size_t condition) {
    const Until& until = phase().until[condition];
    double& calm_since = calm_since_[condition];
    if (std::holds_alternative<AtRest>(until)) {
        const Frame frame = look(Contacts::none);
        double energy = 0, scale = 0;
        for (std::size_t i = 0; i < frame.size(); ++i) {
            const dem::State& state = frame.state;
            if (state.mobile[i] == 0) continue;
            energy += frame.mass(i) / 2 * dot(state.velocity[i], state.velocity[i]);
            scale += frame.mass(i) * norm(spec_.gravity) * 2 * state.radius[i];
        }
        if (!(energy < calm * scale)) calm_since = time();
        return time() - calm_since >= falling_time(spec_);
    }
    if (const auto* empty = std::get_if<Empty>(&until)) return mass_in(empty->region) == 0;
    if (const auto* flow = std::get_if<FlowStops>(&until)) {
        const double mass = mass_in(flow->region);
        if (mass != watched_[condition]) calm_since = time();
        watched_[condition] = mass;
        return time() - calm_since >= flow->quiet;
    }
    if (const auto* quiet = std::get_if<Quiet>(&until)) return is_quiet(*quiet, condition);
    if (const auto* known = std::get_if<Known>(&until)) return is_known(*known);
    const auto& passes = std::get<Passes>(until);
    const double value = watching_[phase_][condition]->look(
        look(find_probe(spec_.measures[passes.measure].probe)->contacts ? Contacts::present : Contacts::none));
    return passes.above ? value > passes.value : value < passes.value;
}

bool Run::is_quiet(const Quiet& quiet, std::size_t condition) {
    const Frame frame = look(Contacts::none);
    double inside = 0, fast = 0;
    const RegionNow here(quiet.region);
    for (std::size_t i = 0; i < frame.size(); ++i) {
        if (frame.state.mobile[i] == 0 || !here.contains(frame.state.position[i])) continue;
        ++inside;
        fast += norm(frame.state.velocity[i]) < quiet.speed ? 0 : 1;
    }
    const double few = std::max(1.0, std::floor(quiet.share * inside));
    if (fast > few || !(std::abs(inside - watched_[condition]) <= few)) {
        calm_since_[condition] = time();
        watched_[condition] = inside;
    }
    return time() - calm_since_[condition] >= quiet.time;
}

bool Run::is_known(const Known& known) const {
    const std::int64_t frames = frame_ - 1;
    const double share = static_cast<double>(frames) / static_cast<double>(phase().frames);
    if (!(known.error > 0) || share < known.from || frames % known.every != 0) return false;
    const auto samples = part_of(records_[known.measure], {phase_, phase_}).samples;
    const bool changed =
        std::ranges::any_of(samples, [&](const Sample& s) { return s.value != samples.front().value; });
    return !changed || find_reduction(spec_.measures[known.measure].reduction)->error(samples) /
                               spec_.measures[known.measure].scale.value <
                           known.error;
}

double Run::progress() const {
    if (finished()) return 1;
    double all = 0, done = 0;
    for (std::size_t p = 0; p < spec_.phases.size(); ++p) {
        all += length_of(spec_.phases[p]);
        if (p < phase_) done += length_of(spec_.phases[p]);
    }
    done += std::min(length_of(phase()), static_cast<double>(step_ - phase_begin_) * spec_.time_step);
    return all > 0 ? std::min(done / all, 1 - 1e-9) : 0;
}

Snapshot Run::snapshot() const {
    Snapshot picture = picture_of(*engine_);
    add_orientations(picture);
    auto& species = picture.scalars["species"];
    for (const double id : picture.scalars["id"]) species.push_back(species_[static_cast<std::size_t>(id)]);
    for (std::size_t k = 0; k < 3; ++k)
        if (spec_.domain.periodic[k]) picture.periods[k] = spec_.domain.length(k);
    const auto walls = walls_now();
    for (const MachineWall& wall : spec_.walls) picture.contacts->walls.push_back(wall.name);
    for (std::size_t w = 0; w < walls.size(); ++w)
        if (walls[w].present)
            picture.walls.push_back(
                surface_of(walls[w], spec_.walls[w].name, spec_.domain.low, spec_.domain.high, engine_->wall_time()));
    add_cells(picture, spec_);
    return picture;
}

double Run::picture_focus() const {
    // A last phase that only measures is not the main part.
    constexpr double least = 0.05;  // of all
    double all = 0;
    for (const Phase& one : spec_.phases) all += length_of(one);
    std::size_t main = spec_.phases.size() - 1;
    while (main > 0 && length_of(spec_.phases[main]) < least * all) --main;
    double start = 0;
    for (std::size_t p = 0; p < main; ++p)
        start = p < times_.end.size() ? times_.end[p] : start + spec_.phases[p].duration;
    return start;
}

bool Run::may_end_early() const {
    return std::ranges::any_of(spec_.phases, [](const Phase& one) { return !one.until.empty(); });
}

template <class State, class Visit>
void Run::fields(State& run, Visit&& visit) {
    visit(run.step_), visit(run.borrowed_particle_steps_), visit(run.wall_zero_), visit(run.newest_),
        visit(run.bed_.position), visit(run.bed_.velocity), visit(run.bed_.radius), visit(run.phase_),
        visit(run.phase_begin_), visit(run.frame_), visit(run.check_);
    visit(run.calm_since_), visit(run.watched_), visit(run.peak_overlap_), visit(run.peak_wall_overlap_),
        visit(run.judged_overlap_), visit(run.judged_wall_overlap_), visit(run.fault_), visit(run.places_),
        visit(run.lost_first_), visit(run.taken_), visit(run.times_.begin);
    visit(run.times_.end), visit(run.ended_by_), visit(run.species_), visit(run.density_), visit(run.radius_);
    if (run.has_clumps()) visit(run.particle_);
    for (auto& record : run.records_)
        visit(record.samples), visit(record.bins), visit(record.sums), visit(record.counts), visit(record.last),
            visit(record.first), visit(record.looked), visit(record.intervals), visit(record.integral);
}

void Run::save(Bytes& into) const {
    into.clear();
    ByteWriter out(into);
    out.put(checkpoint_format);
    fields(*this, [&out](const auto& value) { out.put(value); });
    for (const auto& feeder : feeders_) feeder.save(out);
    for (const auto& probe : probes_) probe->save(out);
    for (const auto& watching : watching_)
        for (const auto& probe : watching)
            if (probe) probe->save(out);
    Bytes of_engine;
    engine_->save(of_engine);
    out.put(of_engine);
}

void Run::restore(std::span<const std::byte> from) {
    ByteReader in(from);
    std::uint64_t format = 0;
    in.get(format);
    if (format != checkpoint_format) throw std::invalid_argument("checkpoint of another scene");
    fields(*this, [&in](auto& value) { in.get(value); });
    for (auto& feeder : feeders_) feeder.restore(in);
    for (auto& probe : probes_) probe->restore(in);
    for (const auto& watching : watching_)
        for (const auto& probe : watching)
            if (probe) probe->restore(in);
    in.require(phase_ <= spec_.phases.size() && times_.begin.size() == std::min(phase_ + 1, spec_.phases.size()) &&
               times_.end.size() == phase_ && ended_by_.size() == phase_);
    in.require(finished() || (calm_since_.size() == phase().until.size() && watched_.size() == calm_since_.size()));
    in.require(newest_ <= species_.size() && bed_.position.size() == bed_.radius.size() &&
               bed_.velocity.size() == bed_.radius.size());
    in.require(species_.size() == density_.size() && species_.size() == radius_.size() &&
               std::ranges::all_of(species_, [this](std::uint8_t s) { return s < spec_.species.size(); }));
    const auto finite = [](const std::vector<double>& times) {
        return std::ranges::all_of(times, [](double t) { return std::isfinite(t); });
    };
    in.require(finite(times_.begin) && finite(times_.end) && phase_begin_ >= 0 && step_ >= phase_begin_);
    in.require(finished() || (phase_begin_ <= most_steps && step_ - phase_begin_ <= phase_steps() && frame_ >= 0 &&
                              frame_ <= phase().frames + 1 && check_ >= 0 && check_ <= phase_steps()));
    for (const auto& record : records_)
        in.require(record.bins.size() == record.sums.size() && record.bins.size() == record.counts.size() &&
                   record.bins.size() == record.last.size());
    Bytes of_engine;
    in.get(of_engine);
    in.finish();
    engine_->restore(of_engine);
    seen_at_.reset();
    engine_->state(spheres_);
    in.require(spheres_.id.empty() || static_cast<std::size_t>(spheres_.id.back()) < species_.size());
    in.require(!has_clumps() ||
               (particle_.size() == species_.size() && std::ranges::all_of(particle_, [this](std::int32_t id) {
                    return id >= 0 && static_cast<std::size_t>(id) < species_.size();
                })));
}

}  // namespace grainsweep::machine
