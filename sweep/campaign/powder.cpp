#include "sweep/campaign/powder.hpp"

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "sweep/campaign/powder_keys.hpp"
#include "sweep/campaign/powder_sizes.hpp"
#include "sweep/campaign/relevance.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/files/whole_file.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/kit/pace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_powder_file = 16ULL << 20U;
constexpr double earth = 9.81;  // m/s2

constexpr double standard_diameter = 0.002, standard_step_fraction = 0.2;

/// Calls visit(field) for the members of a material that a powder file may give.
template <class Visit>
void for_each_member(const Visit& visit) {
    for (const Field& field : powder_keys::material) visit(field);
    for (const auto fields : {dem::contact_fields(), dem::law_fields()})
        for (const Field& field : fields)
            if (std::ranges::find(powder_keys::contacts(), field.name, &Field::name) != powder_keys::contacts().end())
                visit(field);
}

/// Parameters that a powder file may give.
const std::vector<ParameterSpec>& powder_parameters() {
    static const std::vector<ParameterSpec> all = [] {
        std::vector<ParameterSpec> specs;
        dem::Material standard;
        for_each_member([&](const Field& field) {
            ParameterSpec spec{
                std::string(field.name), std::string(field.unit), std::string(field.meaning), 0.0, field.bounds, {}};
            if (field.words.empty()) {
                spec.default_value = *static_cast<const double*>(field.at(&standard));
            } else {
                Words words{{field.words.begin(), field.words.end()}};
                for (const dem::Attraction& one : dem::attractions())
                    if (one.pull_off == nullptr) std::erase(words.allowed, one.word);
                spec.default_value = words.allowed.front();
                spec.bounds = std::move(words);
            }
            specs.push_back(std::move(spec));
        });
        for (const char* name : {"friction", "rolling_friction", "restitution", "cohesion", "surface_energy"}) {
            ParameterSpec spec = *std::ranges::find(specs, name, &ParameterSpec::name);
            spec.name.insert(0, "wall_");
            spec.meaning = "the same at walls; -1: as in the powder";
            spec.default_value = -1.0;
            auto& bounds = std::get<Interval>(spec.bounds);
            bounds.low = -1, bounds.low_open = false;
            specs.push_back(std::move(spec));
        }
        return specs;
    }();
    return all;
}

/// Returns the material of complete inputs; a cohesion that its law does not take is 0.
dem::Material material_of(const Inputs& inputs) {
    dem::Material material;
    for_each_member([&](const Field& field) {
        const Value& value = inputs.find(field.name)->second;
        if (field.words.empty())
            *static_cast<double*>(field.at(&material)) = std::get<double>(value);
        else
            field.choose(&material,
                         static_cast<std::size_t>(std::ranges::find(field.words, std::get<std::string>(value)) -
                                                  field.words.begin()));
    });
    for (const dem::Attraction& one : dem::attractions())
        if (one.key() != dem::attraction_of(material).key()) one.amount(material) = 0;
    return material;
}

/// Calls visit(name, place) for every value of "material" and "contacts".
template <class Visit>
void for_each_property(const Section& top, const Visit& visit) {
    for (const auto& [object, keys] :
         {std::pair{"material", powder_keys::material}, std::pair{"contacts", powder_keys::contacts()}})
        if (const auto place = top.find(object)) {
            const Section section(*place, keys);
            for (const auto& key : keys)
                if (const auto value = section.find(key.name)) visit(std::string(key.name), *value);
        }
}

Section top_of(const Powder& powder) {
    return {Cursor(*powder.document, "$"), powder_keys::top};
}

void check_measured(const Section& top) {
    const auto all = top.find("measured");
    if (!all) return;
    for (const auto& one : all->elements()) {
        const Section section(one, powder_keys::measured);
        (void)section.at("what").text();
        for (const char* key : {"value", "error"})
            if (const auto value = section.find(key); value && !value->json().is_number()) (void)value->text();
        if (const auto how = section.find("how")) (void)how->text();
    }
}

/// To four digits, which are enough for a unit of lengths and read well.
double rounded(double diameter, const PowderSizes& sizes) {
    const double four = std::strtod(fmt::format("{:.4g}", diameter).c_str(), nullptr);
    return four >= sizes.smallest && four <= sizes.largest ? four : diameter;
}

bool is_given(const ParameterSpace& space, std::string_view name) {
    return space.fixed.contains(name) || std::ranges::find(space.factors, name, &Factor::name) != space.factors.end() ||
           std::ranges::find(space.expressions, name, &Expression::name) != space.expressions.end();
}

std::string listed_names(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

const ParameterSpec& powder_parameter(std::string_view name) {
    return *std::ranges::find(powder_parameters(), name, &ParameterSpec::name);
}

std::optional<double> Powder::unit() const {
    if (diameter) return diameter;
    return sizes ? std::optional(rounded(sizes->d50, *sizes)) : std::nullopt;
}

std::string Powder::sizes_name() const {
    return file.filename().string() + " sizes";
}

Powder powder_of(std::string text, const std::string& name,
                 const std::function<std::string(const std::string&)>& read) {
    Powder powder;
    powder.file = name;
    powder.text = std::move(text);
    powder.document = std::make_shared<const Json>(parse_json(powder.text));
    const Section top = top_of(powder);
    powder.name = top.at("powder").text();
    for_each_property(top, [](const std::string& property, const Cursor& place) {
        (void)read_value(place, powder_parameter(property), {});
    });
    check_measured(top);
    read_powder_sizes(top, read, powder);
    if (const auto posterior = top.find("posterior")) {
        powder.posterior = posterior->text();
        try {
            (void)read(posterior->text());
        } catch (const std::invalid_argument& why) {
            posterior->refuse(why.what());
        }
    }
    return powder;
}

Powder read_powder(const fs::path& file) {
    std::error_code error;
    std::string text = files::whole_file(file, error, largest_powder_file);
    if (error) throw input_error(file.string(), "", fmt::format("the powder file cannot be read: {}", error.message()));
    return asked_in(file, [&] {
        const fs::path folder = fs::absolute(file).parent_path();
        Powder powder = powder_of(std::move(text), file.filename().string(), beside(folder));
        powder.file = fs::absolute(file);
        if (powder.sizes && !powder.sizes->source.empty()) powder.sizes->source = folder / powder.sizes->source;
        if (powder.sizes && !powder.sizes->file.empty()) powder.sizes->file = powder.sizes->source;
        if (!powder.posterior.empty()) powder.posterior = folder / powder.posterior;
        return powder;
    });
}

std::string PowderUse::sentence() const {
    std::string text = set.empty() ? std::string("sets nothing") : "sets " + listed_names(set);
    if (!overridden.empty()) text += "; the campaign itself gives " + listed_names(overridden);
    if (!unused.empty()) text += "; the scene has no place for " + listed_names(unused);
    return text;
}

std::string lacks_of(const Powder& powder) {
    const bool sizes = powder.diameter || powder.sizes;
    const auto material = top_of(powder).find("material");
    const bool density = material && Section(*material, powder_keys::material).find("density");
    return sizes ? density ? "" : "density" : density ? "sizes" : "sizes and no density";
}

PowderUse apply_powder(const Powder& powder, ParameterSpace& space) {
    PowderUse use;
    std::vector<std::string> ours;
    const auto hold_value = [&](const std::string& name, const auto& value_for) {
        const auto* parameter = space.scene->find_parameter(name);
        if (parameter == nullptr) return use.unused.push_back(name);
        if (is_given(space, name)) return use.overridden.push_back(name);
        space.fixed[name] = value_for(*parameter);
        ours.push_back(name);
    };
    asked_in(powder.file.filename(), [&] {
        for_each_property(top_of(powder), [&](const std::string& name, const Cursor& place) {
            hold_value(name, [&](const ParameterSpec& parameter) { return read_value(place, parameter, {}); });
        });
        if (const auto unit = powder.unit()) {
            const Json number = *unit;
            hold_value("diameter", [&](const ParameterSpec& parameter) {
                return read_value(Cursor(number, "$.sizes"), parameter, {});
            });
        }
    });
    const bool takes_files = space.scene->find_parameter("size_file") != nullptr &&
                             space.scene->find_parameter("size_distribution") != nullptr;
    if (const auto shape = top_of(powder).find("shape")) {
        const Json& json = shape->json();
        const std::string ratio(ratio_parameter);
        const bool row = json.contains(ratio) && json.at(ratio).is_number() && json.size() == 1;
        if (row && space.scene->find_parameter(ratio) != nullptr)
            hold_value(ratio, [&](const auto& parameter) { return read_value((*shape)[ratio], parameter, {}); });
        else
            use.unused.emplace_back("shape");
    }
    if (powder.sizes && !takes_files) use.unused.emplace_back("sizes beside their d50");
    if (powder.sizes && takes_files) {
        const auto& sizes = *powder.sizes;
        hold_value("size_distribution", [](const ParameterSpec&) { return Value{std::string("file")}; });
        hold_value("size_file", [&](const ParameterSpec&) {
            return Value{sizes.file.empty() ? made_file_word(powder.sizes_name(), sizes.csv)
                                            : fmt::format("file:{}:{}", content_hash(sizes.csv), sizes.file.string())};
        });
    }
    std::vector<std::string> defaults;
    for (const char* name : {"diameter", "density"}) {
        const auto* parameter = space.scene->find_parameter(name);
        if (parameter == nullptr || is_given(space, name)) continue;
        const auto* value = std::get_if<double>(&parameter->default_value);
        if (value != nullptr) defaults.push_back(fmt::format("{} {} {}", name, shortest(*value), parameter->unit));
    }
    if (!defaults.empty())
        use.lacks = fmt::format("powder '{}' has no {}: the scene's own are taken, {}", powder.name, lacks_of(powder),
                                listed_names(defaults));
    for (const auto& name : ours) {  // after all inputs are set: an input without effect on any case keeps its default
        if (!no_effect(space, *space.scene->find_parameter(name)))
            use.set.push_back(name);
        else
            space.fixed.erase(name);
    }
    return use;
}

PowderNumbers numbers_of(const Powder& powder) {
    Inputs inputs;
    for (const auto& parameter : powder_parameters()) inputs.emplace(parameter.name, parameter.default_value);
    for_each_property(top_of(powder), [&](const std::string& name, const Cursor& place) {
        inputs.insert_or_assign(name, read_value(place, powder_parameter(name), {}));
    });
    constexpr double impact = 1;  // m/s
    constexpr double particles = 1000;
    const dem::Material material = material_of(inputs);
    const double diameter = powder.unit().value_or(standard_diameter);
    const double smallest = powder.sizes ? powder.sizes->smallest : diameter;
    PowderNumbers numbers;
    const double weight = material.density * particles::sphere_volume(diameter) * earth;
    numbers.bond_number = dem::attraction_of(material).pull_off(material, diameter / 2) / weight;
    numbers.rayleigh_time = dem::rayleigh_time(material, smallest / 2);
    numbers.time_step = standard_step_fraction * dem::shortest_time(material, smallest / 2, impact);
    numbers.seconds = kit::estimate(dem::Method{}, material, particles, 1 / numbers.time_step).seconds;
    return numbers;
}

}  // namespace grainsweep::campaign
