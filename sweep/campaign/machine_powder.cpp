// "species", "fill" and "feed" of a machine.
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/filling.hpp"
#include "solver/machine/grain_shapes.hpp"
#include "solver/machine/shapes.hpp"
#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

using machine::Species;

constexpr double most_particles = 5e6;
constexpr std::size_t most_fillings = machine::first_feed;  // each draws random numbers of its own

particles::SizeDistribution sizes_of(const Section& section, const MachineReading& reading, double& diameter) {
    using particles::SizeDistribution;
    const auto& scope = reading.scope;
    const auto place = section.find("spread"), file = section.find("file");
    if (!place && !file) throw input_error(section.place().path(), "", "sizes have a \"spread\" or a \"file\"");
    // If a parameter chooses, the values of all choices are beside it.
    const bool chosen = place && place->json().is_string() && place->text().find('{') != std::string::npos;
    const auto words = std::ranges::find(machine_keys::sizes, std::string_view("spread"), &Field::name)->words;
    const auto spread = place ? scope.word(*place, words) : std::string("file");
    for (const auto& [key, of] :
         {std::pair{"half_width", "uniform"}, std::pair{"sigma", "lognormal"}, std::pair{"file", "file"}})
        if (const auto given = section.find(key); given && spread != of && !chosen)
            given->refuse(fmt::format("it belongs to \"spread\": \"{}\"", of));
    if (spread == "file") {
        if (!file) throw input_error(section.place().path(), "", "key 'file' is missing");
        try {
            const auto table = particles::SizeTable::read(reading.contents(*file));
            if (!(diameter > 0)) diameter = SizeDistribution::table(table.over(1)).moment(1);
            const auto sizes = SizeDistribution::table(table.over(diameter));
            if (!(sizes.smallest() <= 1 && sizes.largest() >= 1))
                file->refuse(
                    fmt::format("the sizes are {:.4g} to {:.4g} m, and the diameter {:.4g} m is not among them",
                                sizes.smallest() * diameter, sizes.largest() * diameter, diameter));
            return sizes;
        } catch (const std::invalid_argument& why) {
            file->refuse(why.what());
        }
    }
    if (spread == "monodisperse") return {};
    if (spread == "uniform") return SizeDistribution::uniform(scope.number(section, "half_width", "1", 0.1, {0, 0.9}));
    if (spread == "lognormal") return SizeDistribution::lognormal(scope.number(section, "sigma", "1", 0.2, {0, 1}));
    return SizeDistribution::weibull_classes(spread == "weibull_wide" ? 0.15 : 0.1);
}

/// A region, or {"disc": ...}: the opening of a feeder.
machine::Region feed_region(const Cursor& place, const MachineReading& reading, const machine::Mix& mix) {
    constexpr double thickness = 1.5;  // largest diameters
    if (!place.json().is_object() || !place.json().contains("disc") || place.json().size() != 1)
        return reading.scope.region(place);
    const auto types = machine::shape_types();
    const auto fields = std::ranges::find(types, std::string_view("disc"), &Type::name)->fields;
    machine::Disc disc;
    reading.scope.read(Section(place["disc"], fields), fields, &disc);
    double largest = 0;
    for (const auto& [species, share] : mix) largest = std::max(largest, reading.spec.species[species].widest());
    machine::Region::Round round{disc.centre, disc.normal, disc.radius, disc.inner, thickness * largest};
    round.base = geometry::operator-(round.base, geometry::operator*(round.length / 2, round.axis));
    machine::Region region{round};
    if (const std::string flaw = region.flaw(); !flaw.empty()) place.refuse(flaw);
    return region;
}

/// "species" or "mix" with "by": shares by number.
machine::Mix read_mix(const Section& section, const MachineReading& reading) {
    const auto one = section.find("species"), several = section.find("mix");
    if (one.has_value() == several.has_value())
        throw input_error(section.place().path(), "", "it has either a \"species\" or a \"mix\" of them");
    if (one) return {{reading.scope.place_in(*one, reading.species, "species"), 1.0}};
    if (!several->json().is_object() || several->json().empty())
        several->refuse("must be an object of shares by species");
    const auto words = std::ranges::find(machine_keys::fill, std::string_view("by"), &Field::name)->words;
    const auto by = reading.scope.word(section, "by", words, "mass");
    machine::Mix mix;
    double sum = 0;
    for (const auto& [name, value] : several->json().items()) {
        const Cursor place = (*several)[name];
        const auto found = std::ranges::find(reading.species, name);
        if (found == reading.species.end())
            throw input_error(place.path(), "",
                              fmt::format("must be a species: {}", in_words(WordList(reading.species))),
                              nearest_word(name, reading.species));
        const auto number = static_cast<std::size_t>(found - reading.species.begin());
        const Species& species = reading.spec.species[number];
        double share = reading.scope.number(place, "1", no_negative_number);
        if (by != "count") share /= species.mean_volume();
        if (by == "mass") share /= species.density(reading.spec.densities);
        mix.emplace_back(number, share);
        sum += share;
    }
    if (!(sum > 0)) several->refuse("the shares of a mix must not all be 0");
    for (auto& [number, share] : mix) share /= sum;
    return mix;
}

/// Returns whether a value is a number or a quantity, not an expression.
bool is_literal(const Cursor& place) {
    return place.json().is_number() || value_text(place.text())->quantity;
}

std::int64_t count_of(const Section& section, const MachineReading& reading, const machine::Mix& mix) {
    double volume = 0, mass = 0;  // of a particle, in the mean
    for (const auto& [number, share] : mix) {
        const Species& species = reading.spec.species[number];
        volume += share * species.mean_volume();
        mass += share * species.mean_volume() * species.density(reading.spec.densities);
    }
    const auto given = [&](const char* key) { return static_cast<int>(section.find(key).has_value()); };
    if (given("count") + given("mass") + given("volume") != 1)
        throw input_error(section.place().path(), "", "a filling has one of \"count\", \"mass\" and \"volume\"");
    const char* key = given("count") != 0 ? "count" : given("mass") != 0 ? "mass" : "volume";
    const char* unit = given("count") != 0 ? "1" : given("mass") != 0 ? "kg" : "m3";
    const double one = given("count") != 0 ? 1 : given("mass") != 0 ? mass : volume;
    const Cursor place = section.at(key);
    const double stated = reading.scope.number(place, unit, no_negative_number), count = std::round(stated / one);
    if (stated > 0 && !(count > 0) && !section.flag("exact", false))
        place.refuse(fmt::format("it makes no particle: {:.3g} {} is less than half of {:.3g} {}, the mean of one",
                                 stated, unit, one, unit));
    if (!(stated > 0) && is_literal(place))
        place.refuse("a filling needs at least one particle: remove it, or leave it out with \"when\": 0");
    if (count > most_particles)
        place.refuse(fmt::format("it makes {:.4g} particles; at most {:.4g} can be simulated", count, most_particles));
    return static_cast<std::int64_t>(count);
}

/// Warns of a filling, or a share of its mix, without a particle. An exact volume draws at least one.
void warn_of_none(const Cursor& place, const machine::Fill& fill, MachineReading& reading) {
    if (fill.drawn_to) return;
    auto& warnings = reading.spec.warnings;
    if (fill.count == 0)
        warnings.push_back({"a filling without particles", fmt::format("{} has no particle here", place.path())});
    for (const auto& [species, share] : fill.mix)
        if (const double count = share * static_cast<double>(fill.count); fill.count > 0 && share > 0 && count < 0.5)
            warnings.push_back({"a share of less than half a particle",
                                fmt::format("{}: the share of '{}' in the mix is {:.2g} of a particle here, and there "
                                            "may be none: fill more, or remove it from the mix",
                                            place.path(), reading.species[species], count)});
}

/// Warns of a stated number of particles that grow with particles_scale. An expression with particles_scale, a number
/// of a species or a "let" may depend on it.
void warn_of_kept_count(const Section& fill, MachineReading& reading) {
    const auto count = fill.find("count");
    if (!count || reading.particles_scale == 1) return;
    const auto& scope = reading.scope;
    const auto may_depend = [&](const std::string& name) {
        const auto is_of = [&](const std::string& species) { return name.starts_with(species + "_"); };
        return name == "particles_scale" || scope.is_let(name) || std::ranges::any_of(reading.species, is_of);
    };
    if (!is_literal(*count)) {
        const auto known = [&](std::string_view name) { return scope.has_number(name); };
        const auto parsed = Formula::of(value_text(count->text())->given, known);
        const auto* formula = std::get_if<Formula>(&parsed);
        if (formula == nullptr || std::ranges::any_of(formula->names(), may_depend)) return;
    }
    reading.spec.warnings.push_back(
        {"a count that does not follow particles_scale",
         fmt::format("{}: with particles_scale {:.4g} the count stays, so the mass is {:.3g} times as large: take "
                     "\"mass\" or \"volume\", or divide the count by particles_scale^3",
                     count->path(), reading.particles_scale, std::pow(reading.particles_scale, 3))});
}

/// Returns the volume that a filling states, m3.
double volume_of(const Section& section, const MachineReading& reading, const machine::Mix& mix) {
    if (const auto volume = section.find("volume")) return reading.scope.number(*volume, "m3", no_negative_number);
    const Species& species = reading.spec.species[mix.front().first];
    if (mix.size() > 1 || !section.find("mass"))
        section.at("exact").refuse("it belongs to the \"volume\", or the \"mass\" of one species");
    return reading.scope.number(section.at("mass"), "kg", no_negative_number) / species.density(reading.spec.densities);
}

/// Calls read(phase) for the start or, with "at", for each time that the phase begins. Within it the counter is known.
template <class Read>
void each_time(const Section& section, MachineReading& reading, Read read) {
    const auto at = section.find("at"), as = section.find("counter");
    if (as && !at) as->refuse("it belongs to \"at\"");
    if (!at) return read(std::size_t{0});
    const auto& copies = reading.copies[reading.scope.place_in(*at, reading.phases, "phase")];
    const MachineScope outer = reading.scope;
    for (std::size_t k = 0; k < copies.size(); ++k) {
        if (as) {
            require_name(*as, as->text());
            if (outer.knows(as->text())) as->refuse("a parameter or \"let\" has this name");
            reading.scope.set(as->text(), static_cast<double>(k));
        }
        read(copies[k]);
        reading.scope = outer;
    }
}

machine::Placed placed_sphere(const Cursor& place, const MachineReading& reading, std::size_t species) {
    const Section section(place, machine_keys::sphere);
    const auto& scope = reading.scope;
    dem::Sphere sphere;
    scope.read(section, machine_keys::sphere, &sphere);
    sphere.radius = scope.number(section, "diameter", "m", reading.spec.species[species].diameter, positive_number) / 2;
    const auto given = section.find("orientation");
    if (!given) return {species, sphere, {}};
    if (!given->json().is_array() || given->json().size() != 4) given->refuse("must be a quaternion: w, x, y, z");
    std::array<double, 4> parts{};
    for (std::size_t k = 0; k < 4; ++k) parts[k] = scope.number((*given)[k], "1");
    if (!(geometry::magnitude(parts) > 0)) given->refuse("a quaternion must not be 0");
    return {species, sphere, geometry::normalised(parts)};
}

constexpr std::array<std::string_view, 14> sphere_columns = {"x",  "y",  "z",  "diameter", "vx", "vy", "vz",
                                                             "wx", "wy", "wz", "qw",       "qx", "qy", "qz"};

/// Returns the rows of a CSV file, in SI units. Absent values are 0; an absent diameter is the diameter of the species.
std::vector<machine::Placed> spheres_in_file(const Cursor& place, const MachineReading& reading, std::size_t species) {
    const auto refuse = [&](const std::string& rule) { place.refuse(rule); };
    CsvTable table(reading.contents(place), refuse);
    const auto columns_of = [&](std::string_view name) { return std::ranges::find(table.header(), name); };
    for (const auto& name : table.header())
        if (std::ranges::find(sphere_columns, name) == sphere_columns.end())
            place.refuse(fmt::format("the file has an unknown column '{}'; spheres have {}", name,
                                     in_words(WordList(sphere_columns))));
    for (const char* name : {"x", "y", "z"})
        if (columns_of(name) == table.header().end()) place.refuse(fmt::format("the file has no column '{}'", name));
    std::vector<machine::Placed> all;
    while (const auto row = table.next()) {
        const auto value = [&](std::string_view name, double standard) {
            const auto column = columns_of(name);
            if (column == table.header().end()) return standard;
            const auto& cell = (*row)[static_cast<std::size_t>(column - table.header().begin())];
            const auto number = grainsweep::number_in(cell);
            if (!number) place.refuse(fmt::format("line {}: '{}' is no number", table.number(), cell));
            return *number;
        };
        dem::Sphere sphere;
        sphere.position = {value("x", 0), value("y", 0), value("z", 0)};
        sphere.velocity = {value("vx", 0), value("vy", 0), value("vz", 0)};
        sphere.angular_velocity = {value("wx", 0), value("wy", 0), value("wz", 0)};
        sphere.radius = value("diameter", reading.spec.species[species].diameter) / 2;
        if (!(sphere.radius > 0)) place.refuse(fmt::format("line {}: a diameter must be above 0", table.number()));
        machine::Placed placed{species, sphere, {}};
        const geometry::Quaternion q{value("qw", 1), value("qx", 0), value("qy", 0), value("qz", 0)};
        if (reading.spec.species[species].shape && geometry::magnitude(q) > 0)
            placed.orientation = geometry::normalised(q);
        all.push_back(placed);
    }
    return all;
}

/// Enters the name of a single particle. `falls_apart`: it is a glued clump.
bool take_name(const Cursor& place, MachineReading& reading, bool falls_apart) {
    const std::string name = reading.scope.text(place);
    require_name(place, name);
    if (falls_apart) place.refuse("a glued particle with a shape becomes single spheres, which have no name");
    for (const auto* names : {&reading.species, &reading.named_particles})
        if (std::ranges::find(*names, name) != names->end())
            place.refuse("a species or a particle has this name", name + "_2");
    reading.named_particles.push_back(name);
    return true;
}

/// Returns for each wall with "only" whether it lists the species. read_walls() checks these lists.
std::vector<bool> walls_of_some_that_touch(const Section& top, const std::string& species, const MachineScope& scope) {
    std::vector<bool> touches;
    const auto walls = top.find("walls");
    if (!walls || !walls->json().is_object()) return touches;
    for (const auto& [name, value] : walls->json().items()) {
        if (!value.is_object() || !value.contains("only")) continue;
        const Cursor only = (*walls)[name]["only"];
        const auto lists = [&](const Cursor& one) { return one.json().is_string() && scope.text(one) == species; };
        touches.push_back(only.json().is_array() ? std::ranges::any_of(only.elements(), lists) : lists(only));
    }
    return touches;
}

/// Refuses keys that have no effect beside another one.
void refuse_beside(const Section& section, std::string_view key, std::initializer_list<const char*> others) {
    for (const char* other : others)
        if (const auto too = section.find(other)) too->refuse(fmt::format("beside \"{}\" it has no effect", key));
}

machine::Cut read_cut(const Section& fill, const Cursor& place, const MachineReading& reading) {
    refuse_beside(fill, "packing", {"mix", "by", "count", "mass", "volume", "as", "velocity", "shaken", "spheres"});
    const auto& scope = reading.scope;
    machine::Cut cut;
    cut.species = scope.place_in(fill.at("species"), reading.species, "species");
    const auto equal = [&](const Species& one) {
        return one.sizes.equal() && !one.shape && one.diameter == reading.spec.species[cut.species].diameter;
    };
    if (!std::ranges::all_of(reading.spec.species, equal)) place.refuse("a packing is of spheres that are all equal");
    const auto file = scope.read(fill, "packing", &cut)->find("file");
    const std::string name = file ? scope.text(*file) : std::string();
    if (file && (name == file->text() || file_word(name))) cut.centres = reading.contents(*file);
    cut.in = scope.region(fill.at("in"));
    cut.glued = fill.flag("glued", false);
    if (const auto tight = fill.find("tight")) {
        if (!cut.glued) tight->refuse("only glued spheres are left out");
        cut.tight = scope.number(*tight, "1", {0, 0.5, true, false});
    }
    if (const auto named = fill.find("name")) require_name(*named, cut.name = named->text());
    return cut;
}

/// Returns the species of particles that "fill" and "feed" put at random orientations: not glued ones, single spheres
/// or packings.
std::set<std::string> species_of_powder(const Section& top, const MachineScope& scope) {
    std::set<std::string> names;
    for (const char* key : {"fill", "feed"}) {
        const auto all = top.find(key);
        if (!all || !all->json().is_array()) continue;
        for (const auto& one : all->elements()) {
            const Json& entry = one.json();
            const auto has = [&](const char* name) { return entry.is_object() && entry.contains(name); };
            if (has("spheres") || has("packing") || (has("glued") && entry.at("glued") == true)) continue;
            if (has("species") && entry.at("species").is_string()) names.insert(scope.text(one["species"]));
            if (has("mix") && entry.at("mix").is_object())
                for (const auto& [name, share] : entry.at("mix").items()) names.insert(name);
        }
    }
    return names;
}

}  // namespace

void read_species(const Section& top, MachineReading& reading) {
    const Cursor all = top.at("species");
    if (!all.json().is_object() || all.json().empty()) all.refuse("must be an object of species by name");
    auto& spec = reading.spec;
    const auto powder = reading.aspect_ratio > 1 ? species_of_powder(top, reading.scope) : std::set<std::string>();
    bool elongated = false;
    std::vector<std::pair<std::size_t, std::vector<bool>>> kinds;  // material, and walls of some species that touch
    for (const auto& [name, value] : all.json().items()) {
        const Cursor place = all[name];
        require_name(place, name);
        const Section section(place, machine_keys::species);
        const auto named = section.find("material");
        const auto has_density = [](double density) { return density > 0; };
        if (!named && reading.materials.size() > 1 && std::ranges::count_if(reading.densities, has_density) != 1)
            throw input_error(place.path(), "", "key 'material' is missing: there are several materials");
        const std::size_t material =
            named ? reading.scope.place_in(*named, reading.materials, "material")
            : reading.materials.size() == 1
                ? 0
                : static_cast<std::size_t>(std::ranges::find_if(reading.densities, has_density) -
                                           reading.densities.begin());
        if (!(reading.densities[material] > 0))
            throw input_error(path_of(top.at("materials").path(), reading.materials[material]), "",
                              fmt::format("key 'density' is missing: particles of '{}' are of it", name));
        const auto walls = walls_of_some_that_touch(top, name, reading.scope);
        std::size_t kind = 0;
        while (kind < kinds.size() && kinds[kind] != std::pair(material, walls)) ++kind;
        if (kind == kinds.size()) {
            if (kind == dem::materials_at_most)
                place.refuse(
                    fmt::format("particles are of at most {} materials, and species that walls with \"only\" "
                                "tell apart count as several",
                                dem::materials_at_most));
            kinds.emplace_back(material, walls);
            reading.of_particles.push_back(material);
            spec.materials.push_back(reading.materials[material]);
            spec.densities.push_back(reading.densities[material]);
        }
        Species species;
        species.name = name;
        species.material = static_cast<std::uint8_t>(kind);
        species.diameter = reading.scope.number(section, "diameter", "m", 0, {1e-7, 10});
        if (const auto sizes = section.find("sizes"))
            species.sizes = sizes_of(Section(*sizes, machine_keys::sizes), reading, species.diameter);
        if (const auto shape = section.find("shape"))
            read_grain_shape(*shape, reading, species);
        else if (powder.contains(name))
            species.shape = machine::row_shape(reading.aspect_ratio).clump, elongated = true;
        if (!(species.diameter > 0)) throw input_error(place.path(), "", "key 'diameter' is missing");
        species.diameter *= reading.particles_scale;
        reading.species.push_back(name);
        spec.species.push_back(std::move(species));
    }
    if (spec.species.size() > 200) all.refuse("a machine has at most 200 species");
    if (reading.aspect_ratio > 1 && !elongated)
        throw input_error(std::string(ratio_parameter), fmt::format("{:.4g}", reading.aspect_ratio),
                          "must be 1: the particles of this machine are single ones, cut from a packing, or of a "
                          "\"shape\" of their own");
}

void read_fills(const Section& top, MachineReading& reading) {
    const auto all = top.find("fill");
    if (!all) return;
    if (all->json().size() > most_fillings)
        all->refuse(fmt::format("a machine has at most {} fillings", most_fillings));
    for (const auto& place : all->elements()) {
        const Section section(place, machine_keys::fill);
        if (!reading.scope.present(section)) continue;
        if (const auto packing = section.find("packing")) {
            reading.spec.fills.emplace_back(read_cut(section, *packing, reading));
            continue;
        }
        for (const char* key : {"tight", "name"})
            if (const auto alone = section.find(key)) alone->refuse("it belongs to \"packing\"");
        if (const auto spheres = section.find("spheres")) {
            refuse_beside(section, "spheres",
                          {"mix", "by", "count", "mass", "volume", "in", "as", "velocity", "shaken"});
            if (!section.find("species")) throw input_error(place.path(), "", "key 'species' is missing");
            const bool glued = section.flag("glued", false);
            const std::size_t species = reading.scope.place_in(section.at("species"), reading.species, "species");
            std::vector<machine::Placed> placed;
            if (spheres->json().is_array())
                for (const auto& one : spheres->elements()) {
                    placed.push_back(placed_sphere(one, reading, species));
                    if (const auto name = Section(one, machine_keys::sphere).find("name"))
                        placed.back().named = take_name(*name, reading, glued && reading.spec.species[species].shape);
                }
            else if (spheres->json().is_string())
                placed = spheres_in_file(*spheres, reading, species);
            else
                spheres->refuse("must be a list of spheres, or the name of a CSV file");
            for (auto& one : placed) one.sphere.mobile = !glued;
            reading.spec.fills.emplace_back(std::move(placed));
            continue;
        }
        if (!section.find("in")) throw input_error(place.path(), "", "key 'in' is missing: the region they lie in");
        warn_of_kept_count(section, reading);
        each_time(section, reading, [&](std::size_t phase) {
            machine::Fill fill;
            fill.mix = read_mix(section, reading);
            fill.count = count_of(section, reading, fill.mix);
            reading.scope.read(section, machine_keys::fill, &fill);
            if (section.flag("exact", false)) fill.drawn_to = volume_of(section, reading, fill.mix);
            fill.at = phase;
            warn_of_none(place, fill, reading);
            reading.spec.fills.emplace_back(std::move(fill));
        });
    }
}

void read_removals(const Section& top, MachineReading& reading) {
    const auto all = top.find("remove");
    if (!all) return;
    for (const auto& place : all->elements()) {
        const Section section(place, machine_keys::removal);
        if (!reading.scope.present(section)) continue;
        each_time(section, reading, [&](std::size_t phase) {
            machine::Removal removal;
            reading.scope.read(section, machine_keys::removal, &removal);
            removal.at = phase;
            if (phase > 0) reading.spec.removals.push_back(std::move(removal));
        });
    }
}

void read_feeds(const Section& top, MachineReading& reading) {
    const auto all = top.find("feed");
    if (!all) return;
    for (const auto& place : all->elements()) {
        const Section section(place, machine_keys::feed);
        const auto named = section.find("name");
        machine::Feed feed;
        feed.name = named ? named->text() : "feed";
        if (named) require_name(*named, feed.name);
        if (!reading.scope.present(section)) continue;
        if (std::ranges::find(reading.spec.feeds, feed.name, &machine::Feed::name) != reading.spec.feeds.end())
            place.refuse("several feeds need names of their own", feed.name + "_2");
        feed.mix = read_mix(section, reading);
        reading.scope.read(section, machine_keys::feed, &feed);
        const Cursor through = section.at("through");
        feed.through = feed_region(through, reading, feed.mix);
        const auto bounds = feed.through.bounds();
        double widest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(std::isfinite(bounds.low[k]) && std::isfinite(bounds.high[k])))
                through.refuse("particles are fed into a region with an end on every side");
            if (!(bounds.low[k] < bounds.high[k])) through.refuse("nothing lies in this region");
            widest = std::max(widest, bounds.high[k] - bounds.low[k]);
        }
        const double speed = geometry::norm(feed.velocity);
        double depth = widest;
        for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(feed.velocity[k]) > 0)
                depth = std::min(depth, (bounds.high[k] - bounds.low[k]) * speed / std::abs(feed.velocity[k]));
        const auto every = section.find("every");
        if (!every && !(speed > 0))
            throw input_error(place.path(), "",
                              "a feed needs a \"velocity\", or \"every\": the time from batch to batch");
        feed.interval = every ? reading.scope.number(*every, "s", positive_number) : depth / speed;
        feed.during = read_during(section, reading);
        reading.spec.feeds.push_back(std::move(feed));
    }
}

}  // namespace grainsweep::campaign
