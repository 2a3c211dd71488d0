#include "tests/support/peer_programs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace grainsweep::tests {

namespace {

std::ofstream open(const std::filesystem::path& file) {
    std::ofstream out(file);
    if (!out) throw std::runtime_error("cannot write " + file.string());
    return out;
}

}  // namespace

void write_data(const dem::Setup& s, int types, const std::filesystem::path& file) {
    auto out = open(file);
    out << fmt::format("state\n\n{} atoms\n{} atom types\n\n", s.spheres.size(), types);
    const char* axes = "xyz";
    for (std::size_t a = 0; a < 3; ++a)
        out << fmt::format("{:.17g} {:.17g} {}lo {}hi\n", s.domain.low[a], s.domain.high[a], axes[a], axes[a]);
    out << "\nAtoms\n\n";
    std::size_t id = 0;
    for (const auto& p : s.spheres)
        out << fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ++id, p.mobile ? 1 : 2, 2 * p.radius,
                           s.material.density, p.position[0], p.position[1], p.position[2]);
    out << "\nVelocities\n\n";
    id = 0;
    for (const auto& p : s.spheres)
        out << fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ++id, p.velocity[0], p.velocity[1],
                           p.velocity[2], p.angular_velocity[0], p.angular_velocity[1], p.angular_velocity[2]);
}

std::string gravity_line(const dem::Vec3& g) {
    return fmt::format("fix gravity all gravity {:.17g} vector {:.17g} {:.17g} {:.17g}\n", std::hypot(g[0], g[1], g[2]),
                       g[0], g[1], g[2]);
}

namespace {

std::string repeated(double value, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += fmt::format(" {:.17g}", value);
    return text;
}

}  // namespace

std::string properties(const dem::Material& m, int types) {
    std::string t =
        fmt::format("fix m1 all property/global youngsModulus peratomtype{}\n", repeated(m.youngs_modulus, types)) +
        fmt::format("fix m2 all property/global poissonsRatio peratomtype{}\n", repeated(m.poisson_ratio, types));
    const auto pairs = [&](const char* fix, const char* name, double value) {
        t += fmt::format("fix {} all property/global {} peratomtypepair {}{}\n", fix, name, types,
                         repeated(value, types * types));
    };
    pairs("m3", "coefficientRestitution", m.restitution);
    pairs("m4", "coefficientFriction", m.friction);
    if (m.cohesion > 0) pairs("m5", "cohesionEnergyDensity", m.cohesion);
    if (m.rolling_friction > 0) {
        pairs("m6", "coefficientRollingFriction", m.rolling_friction);
        pairs("m7", "coefficientRollingViscousDamping", m.rolling_damping);
    }
    return t;
}

namespace {

/// LAMMPS's Hertz: k_n = 4/3 E*, k_t = 8 G*, damping gamma_n m* sqrt(R* d) v instead of the exponent 1/4 that makes
/// the restitution constant; gamma_n such that an impact at the powder's speeds loses about as much.
std::string lammps_law(const dem::Material& m) {
    const double reduced = m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
    const double shear = m.youngs_modulus / (4 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio));
    return fmt::format("pair_style gran/hertz/history {:.10g} {:.10g} 2.5e11 NULL {:.10g} 1\npair_coeff * *\n",
                       4.0 / 3 * reduced, 8 * shear, m.friction);
}

}  // namespace

bool installed(const std::string& program) {
    std::istringstream path(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
    for (std::string folder; std::getline(path, folder, ':');)
        if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
    return false;
}

Ran run_timed(const std::vector<std::string>& argv, const std::filesystem::path& folder) {
    const auto output = folder / "peer_output.txt";
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
        const int file = ::open(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
        if (chdir(folder.c_str()) != 0 || file < 0) _exit(126);
        dup2(file, 1), dup2(file, 2);
        setenv("OMP_NUM_THREADS", "1", 1);
        std::vector<char*> words;
        for (const auto& a : argv) words.push_back(const_cast<char*>(a.c_str()));
        words.push_back(nullptr);
        execvp(words[0], words.data());
        _exit(127);
    }
    int status = 0;
    rusage used{};
    if (wait4(child, &status, 0, &used) != child) throw std::runtime_error("lost a process");
    Ran ran;
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ran.user_seconds = static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
    ran.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::ifstream in(output);
    std::ostringstream text;
    text << in.rdbuf();
    ran.out = text.str();
    return ran;
}

Figures figures_of(const dem::State& state, const dem::Setup& setup) {
    Figures f;
    const std::size_t n = state.id.size();
    double largest = 0, mobile = 0;
    for (std::size_t i = 0; i < n; ++i) {
        largest = std::max(largest, 2 * state.radius[i]);
        if (state.mobile[i] == 0) continue;
        ++mobile;
        const auto& v = state.velocity[i];
        const double r = state.radius[i];
        f.kinetic_energy += 0.5 * setup.material.density * 4 / 3 * std::numbers::pi * r * r * r *
                            (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        f.velocity_x += v[0];
    }
    f.velocity_x /= mobile;
    std::array<int, 3> cells{};
    std::array<double, 3> size{};
    for (std::size_t a = 0; a < 3; ++a) {
        size[a] = setup.domain.high[a] - setup.domain.low[a];
        cells[a] = std::max(1, static_cast<int>(size[a] / largest));
    }
    const auto cell = [&](std::size_t i, std::size_t a) {
        const int c = static_cast<int>((state.position[i][a] - setup.domain.low[a]) / size[a] * cells[a]);
        return std::clamp(c, 0, cells[a] - 1);
    };
    std::map<std::array<int, 3>, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < n; ++i) members[std::array<int, 3>{cell(i, 0), cell(i, 1), cell(i, 2)}].push_back(i);
    double contacts = 0;
    for (const auto& [at, here] : members)
        for (int q = 0; q < 27; ++q) {
            std::array<int, 3> other = {at[0] + q % 3 - 1, at[1] + q / 3 % 3 - 1, at[2] + q / 9 - 1};
            for (std::size_t a = 0; a < 3; ++a)
                if (setup.domain.periodic[a]) other[a] = (other[a] + cells[a]) % cells[a];
            const auto there = members.find(other);
            if (there == members.end()) continue;
            for (const auto i : here) {
                if (state.mobile[i] == 0) continue;
                for (const auto j : there->second) {
                    if (i == j) continue;
                    double square = 0;
                    for (std::size_t a = 0; a < 3; ++a) {
                        double d = state.position[i][a] - state.position[j][a];
                        if (setup.domain.periodic[a]) d -= size[a] * std::nearbyint(d / size[a]);
                        square += d * d;
                    }
                    const double reach = state.radius[i] + state.radius[j];
                    contacts += square < reach * reach ? 1 : 0;
                }
            }
        }
    f.coordination = contacts / mobile;
    return f;
}

void write_bed(const dem::Setup& setup, const std::filesystem::path& folder) {
    write_data(setup, 2, folder / "bed.data");
}

std::optional<std::string> deck_of(const dem::Setup& s, const Peer& peer) {
    const bool liggghts = peer.program == Peer::Program::liggghts;
    if (!s.walls.empty()) throw std::invalid_argument("a deck for a bed has no walls");
    if (!liggghts && s.material.cohesion > 0) return std::nullopt;
    std::string t = "units si\n";
    t += liggghts ? "atom_style granular\natom_modify map array\n" : "atom_style sphere\n";
    t += fmt::format("boundary {} {} {}\nnewton off\n", s.domain.periodic[0] ? 'p' : 'f',
                     s.domain.periodic[1] ? 'p' : 'f', s.domain.periodic[2] ? 'p' : 'f');
    t += liggghts ? "communicate single vel yes\n" : "comm_modify vel yes\n";
    if (liggghts && s.material.youngs_modulus < 5e6) t += "soft_particles yes\n";
    t += fmt::format("read_data bed.data\nneighbor {:.10g} bin\nneigh_modify delay 0 every 1 check {}\n", peer.skin,
                     peer.forgetful ? "no" : "yes");
    if (liggghts) {
        t += properties(s.material, 2);
        t += fmt::format("pair_style gran model hertz tangential history{}\npair_coeff * *\n",
                         s.material.cohesion > 0 ? " cohesion sjkr" : "");
    } else {
        t += lammps_law(s.material);
    }
    t += "group base type 2\ngroup mobile type 1\nneigh_modify exclude group base base\n";
    t += fmt::format("timestep {:.10g}\n", s.time_step);
    const auto& g = s.gravity;
    if (std::hypot(g[0], g[1], g[2]) > 0) t += gravity_line(g);
    t += "fix nve mobile nve/sphere\nfix fr base freeze\n"
         "compute c mobile contact/atom\ncompute ca mobile reduce ave c_c\ncompute vm mobile reduce ave vx\n"
         "compute km mobile ke\n"
         "thermo_style custom step c_km c_vm c_ca\nthermo 100000000\nthermo_modify lost warn norm no\n";
    t += fmt::format("run {}\nrun {}\n", peer.warm, peer.steps);
    return t;
}

Figures printed_figures(const std::string& out) {
    Figures f;
    std::istringstream in(out);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        double step = 0, energy = 0, velocity = 0, contacts = 0;
        std::string more;
        if (words >> step >> energy >> velocity >> contacts && !(words >> more)) f = {energy, velocity, contacts};
    }
    return f;
}

namespace {

using Corner = std::array<double, 3>;

void write_blade(const SpreadingPeer& q, double width, const std::filesystem::path& file) {
    constexpr double front = 0.015, thickness = 0.005, top = 0.15;
    constexpr int along = 4, up = 5;  // one quad from bottom to top makes LIGGGHTS 3.8 abort on narrow blades
    const double rear = front - thickness;
    std::vector<std::array<Corner, 4>> quads;
    for (int j = 0; j < along; ++j) {
        const double y0 = width * j / along, y1 = width * (j + 1) / along;
        for (int k = 0; k < up; ++k) {
            const double z0 = q.gap + (top - q.gap) * k / up, z1 = q.gap + (top - q.gap) * (k + 1) / up;
            quads.push_back({{{front, y0, z0}, {front, y1, z0}, {front, y1, z1}, {front, y0, z1}}});
            quads.push_back({{{rear, y1, z0}, {rear, y0, z0}, {rear, y0, z1}, {rear, y1, z1}}});
        }
        quads.push_back({{{rear, y0, q.gap}, {rear, y1, q.gap}, {front, y1, q.gap}, {front, y0, q.gap}}});
        quads.push_back({{{rear, y1, top}, {rear, y0, top}, {front, y0, top}, {front, y1, top}}});
    }
    auto out = open(file);
    out << "solid blade\n";
    for (const auto& quad : quads)
        for (const auto& triangle : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
            out << "facet normal 0 0 0\nouter loop\n";
            for (const int v : triangle) {
                const auto& c = quad[static_cast<std::size_t>(v)];
                out << fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", c[0], c[1], c[2]);
            }
            out << "endloop\nendfacet\n";
        }
    out << "endsolid blade\n";
}

}  // namespace

void write_spreading(const SpreadingPeer& q, const dem::Setup& start, const std::filesystem::path& folder) {
    write_data(start, 1, folder / "start.data");
    write_blade(q, start.domain.high[1] - start.domain.low[1], folder / "blade.stl");
    auto out = open(folder / "in.spread");
    out << "atom_style granular\natom_modify map array\nboundary f p f\nnewton off\ncommunicate single vel yes\n"
           "units si\nread_data start.data\n"
        << fmt::format("neighbor {:.10g} bin\nneigh_modify delay 0\n", 0.2 * q.diameter)
        << properties(start.material, 1) << "pair_style gran model hertz tangential history\npair_coeff * *\n"
        << fmt::format("timestep {:.10g}\n", q.time_step) << gravity_line(start.gravity);
    const char* wall = "fix {} all wall/gran model hertz tangential history primitive type 1 {}plane {:.10g}\n";
    out << fmt::format(fmt::runtime(wall), "base", "z", 0.0) << fmt::format(fmt::runtime(wall), "gate0", "x", 0.015)
        << fmt::format(fmt::runtime(wall), "gate1", "x", 0.015 + q.travel + 0.020)
        << "fix move all nve/sphere\nthermo 100000000\nthermo_modify lost ignore norm no\n"
        << fmt::format("run {}\n", std::llround(q.settle_time / q.time_step))
        << "unfix gate0\nunfix gate1\nreset_timestep 0\n"
           "fix blade all mesh/surface file blade.stl type 1 curvature 1e-5\n"
           "fix bladew all wall/gran model hertz tangential history mesh n_meshes 1 meshes blade\n"
        << fmt::format("fix mv all move/mesh mesh blade linear {:.17g} 0. 0.\n", q.speed)
        << fmt::format("run {}\n", std::llround(q.travel / q.speed / q.time_step));
}

}  // namespace grainsweep::tests
