// A renderer in one file of C++17 without libraries: traces the rays of a pack and writes range.T.npy and face.I.npy of
// each sensor, for `raypencil check`. docs/guide/for-implementers.md explains what it must do; this is the least that does it.
//
//     g++ -O2 -std=c++17 -ffp-contract=off reference/cpp_candidate.cpp -o cpp_candidate && ./cpp_candidate PACK OUT
//
// -ffp-contract=off matters where the compiler may fuse products and sums (-march=native): the edge test below relies on plain ones.
// Reads what packs contain and no more (little endian, NPY 1.0, the layout of terrain.glb in docs/formats/files.md).

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

using Vec = std::array<double, 3>;
static Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
static double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[noreturn]] static void fail(const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    std::exit(2);
}

static std::string slurp(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

// The number that follows `key` in `text` at or after `from`.
static double number_after(const std::string& text, const std::string& key, size_t from = 0) {
    const size_t at = text.find(key, from);
    if (at == std::string::npos) fail("no " + key);
    return std::strtod(text.c_str() + at + key.size(), nullptr);
}

struct Mesh {
    std::vector<Vec> vertices;
    std::vector<std::array<uint32_t, 3>> faces;
};

// The binary chunk of a pack's terrain.glb is all vertices (3 f32 each), then the corners of all faces (3 u32 each) in FaceId
// order. Its only VEC3 is POSITION, and accessor 0: the first "count" is the number of vertices.
static Mesh read_mesh(const std::string& path) {
    const std::string glb = slurp(path);
    uint32_t json_size = 0, data_size = 0;
    std::memcpy(&json_size, glb.data() + 12, 4);
    std::memcpy(&data_size, glb.data() + 20 + json_size, 4);
    const auto count = size_t(number_after(glb.substr(20, json_size), "\"count\":"));
    const char* data = glb.data() + 28 + json_size;
    Mesh mesh;
    for (size_t k = 0; k < count; ++k) {
        float g[3];
        std::memcpy(g, data + 12 * k, 12);
        mesh.vertices.push_back({g[0], -g[2], g[1]});  // glTF is y up: scene (x, y, z) = (gx, -gz, gy)
    }
    mesh.faces.resize((data_size - 12 * count) / 12);
    std::memcpy(mesh.faces.data(), data + 12 * count, 12 * mesh.faces.size());
    return mesh;
}

struct Rays {
    std::string shape;           // "72, 96"
    std::vector<double> numbers; // 6 for each ray: origin, direction
};

static Rays read_rays(const std::string& path) {
    const std::string npy = slurp(path);
    if (npy.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) != 0) fail(path + ": not NPY 1.0");
    const size_t header = uint8_t(npy[8]) + 256 * uint8_t(npy[9]);
    const size_t open = npy.find("'shape': (") + 10;
    Rays rays{npy.substr(open, npy.find(", 6)", open) - open), {}};
    rays.numbers.resize((npy.size() - 10 - header) / 8);
    std::memcpy(rays.numbers.data(), npy.data() + 10 + header, 8 * rays.numbers.size());
    return rays;
}

template <typename T>
static void write_npy(const std::string& path, const char* type, const std::string& shape, const std::vector<T>& values) {
    std::string header = std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
    header.resize((10 + header.size()) / 64 * 64 + 53, ' ');
    header += '\n';
    std::ofstream file(path, std::ios::binary);
    file.write("\x93NUMPY\x01\x00", 8).put(char(header.size() & 255)).put(char(header.size() >> 8)) << header;
    file.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(T)));
    if (!file) fail(path + ": cannot be written");
}

struct Hit {
    double range = std::numeric_limits<double>::infinity();
    uint32_t face = 4294967295;  // none
};

// The nearest front of o + t q with t >= 1 and t |q| <= reach; of equals the lowest index.
static Hit trace(const Mesh& mesh, const Vec& o, const Vec& q, double reach) {
    Hit hit;
    const double length = std::sqrt(dot(q, q));
    for (uint32_t face = 0; face < mesh.faces.size(); ++face) {
        const auto [i, j, k] = mesh.faces[face];
        const Vec &va = mesh.vertices[i], &vb = mesh.vertices[j], &vc = mesh.vertices[k];
        const Vec n = cross(vb - va, vc - va);
        const double facing = dot(n, q);
        if (!(facing < 0)) continue;  // a back, or seen edge on, or without area
        const Vec a = va - o, b = vb - o, c = vc - o;
        // Closed, and the same bits with opposite signs in both faces of an edge: no ray slips through between them.
        if (dot(cross(a, b), q) > 0 || dot(cross(b, c), q) > 0 || dot(cross(c, a), q) > 0) continue;
        const double t = dot(n, a) / facing;
        if (t >= 1 && t * length <= reach && t * length < hit.range) hit = {t * length, face};
    }
    return hit;
}

int main(int count, char** arguments) {
    if (count != 3) fail("usage: cpp_candidate PACK OUT");
    const std::string pack = std::string(arguments[1]) + "/", out = std::string(arguments[2]) + "/";
    const Mesh mesh = read_mesh(pack + "terrain.glb");
    const std::string scene = slurp(pack + "scene.toml");
    size_t table = scene.find("[camera]");
    for (int beam = -1; table != std::string::npos; ++beam) {  // the camera, then each [[beam]]
        const std::string name = beam < 0 ? "camera" : "beam-" + std::to_string(beam);
        const double reach = number_after(scene, "\nmax_range_m = ", table);
        const Rays rays = read_rays(pack + "rays-" + name + ".npy");
        std::vector<double> range;
        std::vector<uint32_t> face;
        for (size_t k = 0; k < rays.numbers.size(); k += 6) {
            const double* r = &rays.numbers[k];
            const Hit hit = trace(mesh, {r[0], r[1], r[2]}, {r[3], r[4], r[5]}, reach);
            range.push_back(hit.range);
            face.push_back(hit.face);
        }
        std::filesystem::create_directories(out + name);
        write_npy(out + name + "/range.T.npy", "<f8", rays.shape, range);
        write_npy(out + name + "/face.I.npy", "<u4", rays.shape, face);
        table = scene.find("[[beam]]", table + 1);
    }
}
