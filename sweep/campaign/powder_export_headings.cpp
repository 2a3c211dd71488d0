// The meaning of a column by the words of its header: English, German, French, Spanish and Italian.
#include "sweep/campaign/powder_export.hpp"

#include "solver/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

namespace grainsweep::campaign {
namespace {

constexpr auto passing_words = std::to_array<std::string_view>(
    {"passing",   "pass",  "undersize", "under",   "finer",   "smaller",     "durchgang",
     "less than", "below", "tamisat",   "passant", "cdf",     "pasante",     "pasa ",
     "cum. <",    "cum <", "% <",       "%<",      "doorval", "cumulative <"});
constexpr auto retained_words = std::to_array<std::string_view>(
    {"retained", "oversize", "over", "coarser", "larger than", "rueckstand", "greater than", "above", "refus",
     "retenido", "trattenuto", "cum. >", "cum >", "% >", "%>", "cumulative >", "residue"});
constexpr auto sum_words =
    std::to_array<std::string_view>({"cum", "kum", "summe", "sum ", "total", "acum", "verteilungssumme"});
constexpr auto each_words = std::to_array<std::string_view>(
    {"chan",    "frequency", "freq",       "haeufigkeit", "different", "diff",       "each",    "class",
     "klasse",  "interval",  " in ",       "volume in",   "relative",  "individual", "partial", "partiel",
     "in band", "histogram", "population", "hundert",     "fraktion",  "count"});
constexpr auto share_words = std::to_array<std::string_view>(
    {"%", "volum", "number", "anzahl", "mass", "masse", "weight", "gew", "share", "anteil", "fraction", "percent",
     "vol", "freq", "intens", "count", "nombre", "peso", "poids"});
constexpr auto size_words = std::to_array<std::string_view>(
    {"size", "diam",   "durchm", "partikel", "groesse", "korn",   "aperture",  "opening", "maschen", "sieve",
     "sieb", "lower",  "upper",  "untere",   "obere",   "klasse", "bin",       "x_",      "tamis",   "mesh",
     "ecd",  "taille", "tamano", "tamiz",    "malla",   "luz",    "ouverture", "setaccio"});
constexpr auto volume_words =
    std::to_array<std::string_view>({"volum", "vol.", "vol%", "vol-%", "vol ", "mass", "masse", "weight", "wt", "gew",
                                     "sieve", "sieb", "tamis", "poids", "peso"});
constexpr auto number_words = std::to_array<std::string_view>({"number", "anzahl", "count", "nombre"});
constexpr auto area_words = std::to_array<std::string_view>({"surface", "area", "oberflaech"});
constexpr auto density_words =
    std::to_array<std::string_view>({"%/um", "1/um", "% / um", "1 / um", "%/mm", "1/mm", "per um", "log", "3lg", "0lg",
                                     "dlg", "/lg", "lg(", "d(ln", "dln", "pdf", "error", "std"});
constexpr auto radius_words = std::to_array<std::string_view>({"radius", "radii", "rayon", "raggio", "radio "});
constexpr auto sieve_weight_words =
    std::to_array<std::string_view>({"empty", "tare", "leer", "tara", "sieve +", "sieve+", "with sample", "sieve and",
                                     "voll", "brutto", "gross", "vide"});

/// Letters and digits of a header, with its case.
std::string symbol_of(std::string_view header) {
    std::string symbol;
    for (const char c : header)
        if (std::string_view(" ()[]{}/_,;:%").find(c) == std::string_view::npos) symbol += c;
    return symbol;
}

/// Cumulative and density symbols of ISO 9276-1: Q3 is the sum of q3, by volume; Q0 and q0 are by number.
struct Symbols {
    bool below = false, above = false, step = false, density = false;
    std::optional<std::string> by;
};

Symbols symbols_in(const std::string& header, const std::string& plain) {
    Symbols found;
    constexpr std::array<std::pair<char, const char*>, 3> bases = {{{'0', "number"}, {'2', "area"}, {'3', "volume"}}};
    const std::string symbol = symbol_of(header);
    for (const auto& [digit, by] : bases) {
        const auto has = [&](const std::string& name) { return symbol.find(name + digit) != std::string::npos; };
        const bool above =
            has("1-Q") || has("100-Q") || has("1\xE2\x88\x92Q") || symbol.starts_with(std::string("R") + digit);
        const bool step =
            has("dQ") || has("\xCE\x94Q") || has("\xE2\x88\x86Q") || plain.find(std::string("p") + digit) == 0;
        if (above || step || has("Q") || has("q")) found.by = by;
        found.above = found.above || above;
        found.step = found.step || step;
        found.below = found.below || (has("Q") && !above && !step);
        found.density = found.density || (has("q") && !step);
    }
    return found;
}

/// "x [um]", "Size (um)" and "D/um" -> "um"; empty: none.
std::string length_in(const std::string& plain) {
    std::string word;
    char before = ' ';
    for (std::size_t k = 0; k <= plain.size(); ++k) {
        const char c = k < plain.size() ? plain[k] : ' ';
        if (std::string_view(" ()[],;:/_=").find(c) == std::string_view::npos) {
            word += c;
            continue;
        }
        const std::string unit = length_unit(word);
        // "Volume In %" is no length in inches, and m is a mass as often as a metre.
        const bool bracketed = (before == '(' && c == ')') || (before == '[' && c == ']');
        if (!unit.empty() && ((unit != "in" && unit != "m") || word == "inch" || word == "inches" || bracketed))
            return unit;
        word.clear();
        before = c;
    }
    return {};
}

bool counts_only(const std::string& plain) {
    constexpr auto names = std::to_array<std::string_view>(
        {"no",          "no.", "nr",   "nr.",      "#",       "channel",   "channel #",  "channel number",
         "channel no.", "ch",  "ch.",  "kanal",    "bin #",   "class no.", "klasse nr.", "index",
         "row",         "pos", "pos.", "lfd. nr.", "channels"});
    return std::ranges::find(names, plain) != names.end();
}

bool is_sieve_number(const std::string& plain) {
    const bool sieve = plain.find("sieve") != plain.npos || plain.find("sieb") != plain.npos;
    const bool number = plain.find("no.") != plain.npos || plain.find(" no") != plain.npos ||
                        plain.find("number") != plain.npos || plain.find('#') != plain.npos ||
                        plain.find("designation") != plain.npos;
    return (sieve && number) || plain.find("mesh") != plain.npos || plain.find("astm") != plain.npos ||
           plain.find("tyler") != plain.npos;
}

std::optional<std::string> basis_in(const std::string& plain) {
    const bool number = has_word(plain, number_words), volume = has_word(plain, volume_words),
               area = has_word(plain, area_words), intensity = plain.find("intens") != plain.npos;
    if ((number ? 1 : 0) + (volume ? 1 : 0) + (area ? 1 : 0) + (intensity ? 1 : 0) != 1) return std::nullopt;
    return number ? "number" : volume ? "volume" : area ? "area" : "intensity";
}

void set_kind(ExportHeading& heading, const Symbols& symbols) {
    const auto& plain = heading.plain;
    // "D [%]" and "R [%]" of DIN 66145 are Durchgang and Rueckstand.
    const std::string letter = symbol_of(plain);
    const bool percent = plain.find('%') != plain.npos;
    const bool passing = has_word(plain, passing_words) || symbols.below || (percent && letter == "d");
    const bool retained = has_word(plain, retained_words) || symbols.above;
    const bool sum = has_word(plain, sum_words) || (percent && letter == "r") || symbols.above;
    const bool each = has_word(plain, each_words) || symbols.step;
    if (symbols.step)
        heading.as = "each";
    else if (passing && !retained)
        heading.as = "passing";
    else if (sum)
        heading.as = retained || letter == "r" ? "retained" : "sum";
    else if (each)
        heading.as = "each";
}

}  // namespace

ExportHeading export_heading(const std::string& header) {
    ExportHeading heading;
    heading.plain = std::string(trimmed(plain_words(header)));
    const auto& plain = heading.plain;
    const Symbols symbols = symbols_in(header, plain);
    const bool percent = plain.find('%') != plain.npos || plain.find("percent") != plain.npos;
    heading.length = length_in(plain);
    heading.percentile = plain.find("%tile") != plain.npos || plain.find("percentile") != plain.npos ||
                         plain.find("perzentil") != plain.npos || plain.find("% tile") != plain.npos;
    heading.ignored = counts_only(plain);
    heading.with_sieve = has_word(plain, sieve_weight_words);
    if (heading.ignored || heading.with_sieve) return heading;
    set_kind(heading, symbols);
    const bool per_length = has_word(plain, density_words);
    const bool named_density = plain.find("densit") != plain.npos || plain.find("dichte") != plain.npos;
    heading.density = per_length || ((named_density || symbols.density) && !percent && !symbols.step);
    if (named_density && percent && !per_length) heading.as = "each";
    heading.share = heading.as.has_value() || symbols.by || has_word(plain, share_words) ||
                    has_word(plain, retained_words) || heading.percentile;
    heading.by = symbols.by ? symbols.by : basis_in(plain);
    if (heading.density && !symbols.step) heading.as.reset();
    // "Size classes (um)" and "Particle size, volume (um)" are sizes: a length decides. So do the numbers of sieves.
    heading.sieve_number =
        is_sieve_number(plain) && heading.length.empty() && !percent && plain.find("(g)") == plain.npos;
    if (plain == "phi" || plain.starts_with("phi ") || plain.ends_with(" phi") || plain.find("(phi") != plain.npos ||
        plain.find("[phi") != plain.npos)
        heading.length = heading.length.empty() && !percent ? "phi" : heading.length;
    if ((!heading.length.empty() && !percent && !heading.density) || heading.sieve_number) heading.share = false;
    const bool symbol = plain == "x" || plain == "d" || plain.starts_with("x ") || plain.starts_with("d ") ||
                        plain.starts_with("x/") || plain.starts_with("d/") || plain.starts_with("x(") ||
                        plain.starts_with("d(") || plain.starts_with("x[") || plain == "xo" || plain == "xu" ||
                        plain == "xm" || plain == "x0";
    heading.size = !heading.share && !heading.density &&
                   (has_word(plain, size_words) || !heading.length.empty() || heading.sieve_number || symbol);
    if (heading.size) heading.as.reset();
    heading.radius = heading.size && has_word(plain, radius_words);
    return heading;
}

}  // namespace grainsweep::campaign
