#include "sweep/campaign/powder_sizes.hpp"

#include "sweep/campaign/powder_keys.hpp"
#include "sweep/campaign/quantity.hpp"

#include "solver/particles/size_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

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

}  // namespace

double powder_number(const Cursor& place, std::string_view unit) {
    const auto& json = place.json();
    if (!json.is_string()) return place.number({0, std::numeric_limits<double>::infinity(), true, true});
    const auto value = in_si(json.get_ref<const std::string&>(), unit);
    if (const auto* why = std::get_if<std::string>(&value))
        place.refuse(fmt::format("must be a number above 0{}: {}", unit == "1" ? "" : fmt::format(" {}", unit), *why));
    if (!(std::get<double>(value) > 0)) place.refuse("must be a number above 0");
    return std::get<double>(value);
}

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
