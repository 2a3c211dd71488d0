#include "sweep/campaign/powder.hpp"

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "sweep/campaign/powder_keys.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/relevance.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/files/whole_file.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/particles/size_laws.hpp"
#include "solver/particles/size_table.hpp"
#include "solver/scenes/kit/pace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
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

/// Returns a positive number in `unit`; the text may have another unit.
double powder_number(const Cursor& place, std::string_view unit) {
    const auto& json = place.json();
    if (!json.is_string()) return place.number({0, std::numeric_limits<double>::infinity(), true, true});
    const auto value = in_si(json.get_ref<const std::string&>(), unit);
    if (const auto* why = std::get_if<std::string>(&value))
        place.refuse(fmt::format("must be a number above 0{}: {}", unit == "1" ? "" : fmt::format(" {}", unit), *why));
    if (!(std::get<double>(value) > 0)) place.refuse("must be a number above 0");
    return std::get<double>(value);
}

using particles::SizeTable;

std::string of_three(const Section& sizes, int power) {
    for (const char* key : {"d10", "d50", "d90"})
        if (!sizes.find(key))
            throw input_error(sizes.place().path(), "",
                              fmt::format("key '{}' is missing: d10, d50 and d90 belong together", key));
    const double d10 = powder_number(sizes.at("d10"), "m"), d50 = powder_number(sizes.at("d50"), "m"),
                 d90 = powder_number(sizes.at("d90"), "m");
    if (!(d10 < d50 && d50 < d90)) throw input_error(sizes.place().path(), "", "d10, d50 and d90 must rise");
    return particles::lognormal_table(d50, particles::half_spread(d50, d10), particles::half_spread(d50, d90), power);
}

std::string of_lognormal(const Section& law, int power) {
    const auto sigma = law.find("sigma"), ratio = law.find("ratio");
    if (sigma.has_value() == ratio.has_value())
        throw input_error(law.place().path(), "", "a lognormal distribution has either \"sigma\" or \"ratio\"");
    const double median = powder_number(law.at("median"), "m");
    const double spread = sigma ? powder_number(*sigma, "1") : std::log(powder_number(*ratio, "1"));
    if (!(spread > 0 && spread <= 2))
        (sigma ? *sigma : *ratio).refuse("the standard deviation of ln d must be above 0 and at most 2");
    return particles::lognormal_table(median, spread, spread, power);
}

std::string of_rosin_rammler(const Section& law, int power) {
    const double d63 = powder_number(law.at("d63"), "m"), n = powder_number(law.at("n"), "1");
    if (!(n >= 0.5 && n <= 50)) law.at("n").refuse("the exponent must be from 0.5 to 50");
    return particles::rosin_rammler_table(d63, n, power);
}

std::string csv_of(const Section& sizes, const std::function<std::string(const std::string&)>& read,
                   PowderSizes& into) {
    const std::string by = sizes.word("by", "volume");
    const int power = by == "number" ? 0 : by == "area" ? 2 : 3;  // mass is volume of grains of one density
    if (const auto file = sizes.find("file")) {
        if (const auto basis = sizes.find("by")) basis->refuse("the header of the file states it; leave it out");
        into.file = into.source = file->text();
        try {
            return read(file->text());
        } catch (const std::invalid_argument& why) {
            file->refuse(why.what());
        }
    }
    if (const auto law = sizes.find("lognormal")) return of_lognormal(Section(*law, powder_keys::lognormal), power);
    if (const auto law = sizes.find("rosin_rammler"))
        return of_rosin_rammler(Section(*law, powder_keys::rosin_rammler), power);
    return of_three(sizes, power);
}

SizeTable cut_table(const SizeTable& table, const Section& cut, PowderSizes& into) {
    const auto below = cut.find("below"), above = cut.find("above");
    if (!below && !above) throw input_error(cut.place().path(), "", "a cut has \"below\", \"above\" or both");
    const double low = below ? powder_number(*below, "m") : 0;
    const double high = above ? powder_number(*above, "m") : 2 * table.largest();
    if (!(low < high)) throw input_error(cut.place().path(), "", "\"below\" must be less than \"above\"");
    into.cut_below = table.share_below(std::nextafter(low, 0.0), 3);
    into.cut_above = 1 - table.share_below(high, 3);
    try {
        return table.between(low, high);
    } catch (const std::invalid_argument& nothing) {
        cut.place().refuse(nothing.what());
    }
}

/// Reads "sizes" and "cut" into the powder; `read` returns the contents of the file that "sizes" names.
void read_powder_sizes(const Section& top, const std::function<std::string(const std::string&)>& read, Powder& powder) {
    const auto place = top.find("sizes"), cut = top.find("cut");
    if (!place) {
        if (cut) cut->refuse("it cuts \"sizes\", and there are none");
        return;
    }
    const Section sizes(*place, powder_keys::sizes);
    const auto given = [&](const char* key) { return sizes.find(key) ? 1 : 0; };
    const bool three = given("d10") + given("d50") + given("d90") > 0;
    if (given("file") + given("diameter") + given("lognormal") + given("rosin_rammler") + (three ? 1 : 0) != 1)
        throw input_error(place->path(), "",
                          "sizes are given by one of \"file\", \"diameter\", \"d10\" with \"d50\" and \"d90\", "
                          "\"lognormal\" and \"rosin_rammler\"");
    if (const auto diameter = sizes.find("diameter")) {
        if (cut) cut->refuse("all particles are equal: there is nothing to cut");
        powder.diameter = powder_number(*diameter, "m");
        return;
    }
    PowderSizes result;
    result.csv = csv_of(sizes, read, result);
    try {
        SizeTable table = SizeTable::read(result.csv);
        if (cut) {
            table = cut_table(table, Section(*cut, powder_keys::cut), result);
            result.csv = table.text();
            result.file.clear();
            table = SizeTable::read(result.csv);
        }
        result.d10 = table.quantile(0.1, 3), result.d50 = table.quantile(0.5, 3), result.d90 = table.quantile(0.9, 3);
        result.number_d10 = table.quantile(0.1, 0), result.number_d50 = table.quantile(0.5, 0);
        result.number_d90 = table.quantile(0.9, 0);
        result.smallest = table.smallest(), result.largest = table.largest();
    } catch (const std::invalid_argument& why) {
        place->refuse(fmt::format(
            "{}{}", why.what(), sizes.find("file") ? "; grainsweep powder import makes such a file of an export" : ""));
    }
    powder.sizes = std::move(result);
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

std::vector<SizeClass> size_classes(const PowderSizes& sizes, int count) {
    const SizeTable table = SizeTable::read(sizes.csv);
    const double ratio = std::pow(sizes.largest / sizes.smallest, 1.0 / count);
    std::vector<SizeClass> classes;
    double from = sizes.smallest;
    for (int k = 0; k < count; ++k) {
        const double to = k + 1 == count ? sizes.largest : from * ratio;
        const auto share = [&](int power) {  // classes with one size each count where they lie, the largest in the last
            const double end = k + 1 == count ? 2 * to : to;
            return table.share_below(std::nextafter(end, 0.0), power) -
                   table.share_below(std::nextafter(from, 0.0), power);
        };
        classes.push_back({from, to, share(3), share(0)});
        from = to;
    }
    return classes;
}

}  // namespace grainsweep::campaign
