// Powder file: material, sizes, contacts, measurements. A campaign file that names a powder file takes parameters of
// its scene from it.
#pragma once

#include "solver/scenes/values.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::campaign {

struct ParameterSpace;

/// Sizes of a powder after its cut.
struct PowderSizes {
    std::string csv;                   ///< in the form of a scene's size_file
    std::filesystem::path file;        ///< file with exactly these contents; empty: the program made them
    std::filesystem::path source;      ///< file that "sizes" names; empty: none
    double d10 = 0, d50 = 0, d90 = 0;  ///< by volume, m
    double number_d10 = 0, number_d50 = 0, number_d90 = 0;
    double smallest = 0, largest = 0;     ///< m
    double cut_below = 0, cut_above = 0;  ///< removed shares of the mass
};

struct Powder {
    std::string name;
    std::filesystem::path file;
    std::string text;                                ///< of the file
    std::shared_ptr<const nlohmann::json> document;  ///< the parsed file
    std::optional<double> diameter;                  ///< if all are equal, m
    std::optional<PowderSizes> sizes;
    std::filesystem::path posterior;  ///< of a calibration; empty: none

    /// Returns the diameter that represents the powder: the common one, or d50 by volume; empty without sizes.
    [[nodiscard]] std::optional<double> unit() const;
    /// Returns the name of sizes made by the program: "ti64.json sizes".
    [[nodiscard]] std::string sizes_name() const;
};

/// Returns the parameter of the scenes for a key of "material" or "contacts".
[[nodiscard]] const ParameterSpec& powder_parameter(std::string_view name);
/// Reads and checks the text of a powder file; `read` returns the contents of its files. Throws InputError with the
/// path and the rule.
[[nodiscard]] Powder powder_of(std::string text, const std::string& name,
                               const std::function<std::string(const std::string&)>& read);
/// Reads and checks a powder file and the files beside it that it names. Throws InputError with the file, the path
/// and the rule.
[[nodiscard]] Powder read_powder(const std::filesystem::path& file);

/// Parameters that a powder sets in a scene. Parameters that the campaign sets do not change.
struct PowderUse {
    std::vector<std::string> set, overridden, unused;
    std::string lacks;  ///< sizes or density that neither the powder nor the campaign gives, with the defaults in use

    /// Returns a text such as "sets density, friction; given by the campaign: ...; not used by this scene: ...".
    [[nodiscard]] std::string sentence() const;
};
/// Fixes the parameters that the powder has and the space does not set. A scene without a size file gets only the
/// diameter. Throws InputError if a value is invalid in the scene.
[[nodiscard]] PowderUse apply_powder(const Powder& powder, ParameterSpace& space);

/// Returns "sizes and density" and the like: what a powder file lacks of them. Empty: nothing.
[[nodiscard]] std::string lacks_of(const Powder& powder);

/// Derived numbers of a powder: cohesion under gravity, and cost.
struct PowderNumbers {
    double bond_number = 0;    ///< pull-off force divided by weight at the diameter unit() and 9.81 m/s2; 0: no
                               ///< cohesion
    double rayleigh_time = 0;  ///< of the smallest particle, s
    double time_step = 0;      ///< of the scenes with the default fraction and an impact speed of 1 m/s, s
    double seconds = 0;        ///< of one core, for 1,000 particles and 1 s
};
[[nodiscard]] PowderNumbers numbers_of(const Powder& powder);
/// Class of sizes with its shares of volume and number; classes have equal ratios, from the smallest size to the
/// largest.
struct SizeClass {
    double from = 0, to = 0, volume = 0, number = 0;
};
[[nodiscard]] std::vector<SizeClass> size_classes(const PowderSizes& sizes, int count);

}  // namespace grainsweep::campaign
