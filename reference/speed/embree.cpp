// Times Embree 4 on the triangles and rays that the example `speed` writes, on one thread and by every call that Embree
// has for such rays.
//
//     embree FOLDER ROUNDS THREADS
//
// FOLDER holds vertices.f32, faces.u32, and camera.f32, beams.f32, shadow.f32: eight numbers a ray, its origin, direction,
// nearest and farthest t. Prints one line of JSON: milliseconds of each round, and how many rays hit.
//
// It is compiled without Embree's headers, which the Python package `embreex` does not bring along: the few declarations
// below follow Embree's documented interface (version 4.4). A ray with a known answer checks them before anything is timed.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

extern "C" {
typedef struct Device *RTCDevice;
typedef struct Scene *RTCScene;
typedef struct Geometry *RTCGeometry;

RTCDevice rtcNewDevice(const char *config);
void rtcReleaseDevice(RTCDevice);
int rtcGetDeviceError(RTCDevice);
RTCScene rtcNewScene(RTCDevice);
void rtcReleaseScene(RTCScene);
void rtcSetSceneFlags(RTCScene, int);
void rtcSetSceneBuildQuality(RTCScene, int);
void rtcCommitScene(RTCScene);
RTCGeometry rtcNewGeometry(RTCDevice, int type);
void rtcSetSharedGeometryBuffer(RTCGeometry, int type, unsigned slot, int format, const void *, size_t offset, size_t stride,
                                size_t count);
void rtcSetGeometryBuildQuality(RTCGeometry, int);
void rtcCommitGeometry(RTCGeometry);
unsigned rtcAttachGeometry(RTCScene, RTCGeometry);
void rtcReleaseGeometry(RTCGeometry);
void rtcIntersect1(RTCScene, void *ray_hit, void *arguments);
void rtcIntersect16(const int *valid, RTCScene, void *ray_hit, void *arguments);
void rtcOccluded1(RTCScene, void *ray, void *arguments);
void rtcOccluded16(const int *valid, RTCScene, void *ray, void *arguments);
}

namespace {

// Values of Embree's enumerations.
constexpr int TRIANGLES = 0, INDEX_BUFFER = 0, VERTEX_BUFFER = 1, FLOAT3 = 0x9003, UINT3 = 0x5003;
constexpr int MEDIUM = 1, ROBUST = 1 << 2, COHERENT = 1 << 16;
constexpr uint32_t NOTHING = ~0u;

template <int N> struct alignas(N == 1 ? 16 : 4 * N) Ray {
    float ox[N], oy[N], oz[N], tnear[N], dx[N], dy[N], dz[N], time[N], tfar[N];
    uint32_t mask[N], id[N], flags[N];
};

template <int N> struct alignas(N == 1 ? 16 : 4 * N) RayHit {
    Ray<N> ray;
    float ngx[N], ngy[N], ngz[N], u[N], v[N];
    uint32_t face[N], geometry[N], instance[N], instance_part[N];
};

struct Arguments {
    int flags;
    uint32_t features = ~0u;
    void *context = nullptr, *filter = nullptr, *function = nullptr;
    float width_factor = 0; // exists in some builds of Embree only
};

struct Input {
    float o[3], d[3], near, far;
};

template <typename T> std::vector<T> read(const std::string &path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) {
        std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
        std::exit(2);
    }
    std::vector<T> items(size_t(file.tellg()) / sizeof(T));
    file.seekg(0);
    file.read(reinterpret_cast<char *>(items.data()), std::streamsize(items.size() * sizeof(T)));
    return items;
}

double milliseconds(auto &&work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

template <int N> void set(Ray<N> &ray, int lane, const Input &in) {
    ray.ox[lane] = in.o[0], ray.oy[lane] = in.o[1], ray.oz[lane] = in.o[2];
    ray.dx[lane] = in.d[0], ray.dy[lane] = in.d[1], ray.dz[lane] = in.d[2];
    ray.tnear[lane] = in.near, ray.tfar[lane] = in.far, ray.time[lane] = 0;
    ray.mask[lane] = ~0u, ray.id[lane] = 0, ray.flags[lane] = 0;
}

struct Ground {
    std::vector<float> vertices;
    std::vector<uint32_t> faces;
    RTCDevice device;
    RTCScene scene = nullptr;

    Ground(std::vector<float> v, std::vector<uint32_t> f, const std::string &config)
        : vertices(std::move(v)), faces(std::move(f)), device(rtcNewDevice(config.c_str())) {
        vertices.push_back(0); // Embree reads 16 bytes of the last vertex
    }

    void build(int flags) {
        if (scene) rtcReleaseScene(scene);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, flags);
        rtcSetSceneBuildQuality(scene, MEDIUM);
        RTCGeometry geometry = rtcNewGeometry(device, TRIANGLES);
        rtcSetSharedGeometryBuffer(geometry, VERTEX_BUFFER, 0, FLOAT3, vertices.data(), 0, 12, vertices.size() / 3);
        rtcSetSharedGeometryBuffer(geometry, INDEX_BUFFER, 0, UINT3, faces.data(), 0, 12, faces.size() / 3);
        rtcSetGeometryBuildQuality(geometry, MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        if (int error = rtcGetDeviceError(device)) {
            std::fprintf(stderr, "Embree: error %d\n", error);
            std::exit(2);
        }
    }
};

// The first hits of all rays, as t and face, like a range map.
struct Map {
    std::vector<float> t;
    std::vector<uint32_t> face;
    explicit Map(size_t count) : t(count), face(count) {}
};

void first_1(RTCScene scene, const std::vector<Input> &rays, Map &map, int flags) {
    Arguments arguments{flags};
    RayHit<1> ray;
    for (size_t k = 0; k < rays.size(); ++k) {
        set(ray.ray, 0, rays[k]);
        ray.geometry[0] = ray.face[0] = NOTHING;
        rtcIntersect1(scene, &ray, &arguments);
        map.t[k] = ray.ray.tfar[0];
        map.face[k] = ray.face[0];
    }
}

// Sixteen rays in the order given: neighbours of a row.
void first_16(RTCScene scene, const std::vector<Input> &rays, Map &map, int flags) {
    Arguments arguments{flags};
    RayHit<16> packet;
    alignas(64) int valid[16];
    for (size_t k = 0; k < rays.size(); k += 16) {
        for (int lane = 0; lane < 16; ++lane) {
            valid[lane] = k + lane < rays.size() ? -1 : 0;
            set(packet.ray, lane, rays[valid[lane] ? k + lane : k]);
            packet.geometry[lane] = packet.face[lane] = NOTHING;
        }
        rtcIntersect16(valid, scene, &packet, &arguments);
        for (int lane = 0; lane < 16 && valid[lane]; ++lane) {
            map.t[k + lane] = packet.ray.tfar[lane];
            map.face[k + lane] = packet.face[lane];
        }
    }
}

// Occluded rays get the t of minus infinity.
void any_1(RTCScene scene, const std::vector<Input> &rays, Map &map, int flags) {
    Arguments arguments{flags};
    Ray<1> ray;
    for (size_t k = 0; k < rays.size(); ++k) {
        set(ray, 0, rays[k]);
        rtcOccluded1(scene, &ray, &arguments);
        map.face[k] = ray.tfar[0] < 0 ? 0 : NOTHING;
    }
}

void any_16(RTCScene scene, const std::vector<Input> &rays, Map &map, int flags) {
    Arguments arguments{flags};
    Ray<16> packet;
    alignas(64) int valid[16];
    for (size_t k = 0; k < rays.size(); k += 16) {
        for (int lane = 0; lane < 16; ++lane) {
            valid[lane] = k + lane < rays.size() ? -1 : 0;
            set(packet, lane, rays[valid[lane] ? k + lane : k]);
        }
        rtcOccluded16(valid, scene, &packet, &arguments);
        for (int lane = 0; lane < 16 && valid[lane]; ++lane)
            map.face[k + lane] = packet.tfar[lane] < 0 ? 0 : NOTHING;
    }
}

using Cast = void (*)(RTCScene, const std::vector<Input> &, Map &, int);

// The declarations above are right: rays straight down at x = 0.25 to 1.65 meet face 0, face 1 or nothing at t = 2.
void check_declarations() {
    Ground two({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {0, 1, 2, 1, 3, 2}, "threads=1");
    two.build(ROBUST);
    std::vector<Input> rays;
    for (int k = 0; k < 21; ++k) rays.push_back({{0.25f + 0.07f * float(k), 0.3f, 2}, {0, 0, -1}, 0, 10});
    for (Cast cast : {first_1, first_16, any_1, any_16}) {
        Map map(rays.size());
        cast(two.scene, rays, map, 0);
        const bool is_first = cast == first_1 || cast == first_16;
        for (size_t k = 0; k < rays.size(); ++k) {
            const float x = rays[k].o[0];
            const uint32_t face = x > 1 ? NOTHING : is_first && x > 0.7f ? 1 : 0;
            if (map.face[k] != face || (is_first && map.t[k] != (face == NOTHING ? 10.0f : 2.0f))) {
                std::fprintf(stderr, "this Embree is not laid out as its version 4.4: ray %zu\n", k);
                std::exit(2);
            }
        }
    }
}

void print(const char *name, const std::vector<double> &times) {
    std::printf("\"%s\": [", name);
    for (size_t k = 0; k < times.size(); ++k) std::printf("%s%.6g", k ? ", " : "", times[k]);
    std::printf("], ");
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 4) {
        std::fprintf(stderr, "expected: embree FOLDER ROUNDS THREADS\n");
        return 2;
    }
    const std::string folder = argv[1];
    const int rounds = std::atoi(argv[2]);
    check_declarations();
    Ground ground(read<float>(folder + "/vertices.f32"), read<uint32_t>(folder + "/faces.u32"),
                  std::string("threads=") + argv[3]);
    std::printf("{");

    std::vector<double> times;
    for (int round = 0; round < rounds; ++round) times.push_back(milliseconds([&] { ground.build(ROBUST); }));
    print("tree", times);

    // One thread calls, however many have built the tree.
    struct {
        const char *rays;
        Cast cast;
        const char *name;
        int flags;
    } const works[] = {
        {"camera", first_1, "camera, single", 0},      {"camera", first_16, "camera, packets", COHERENT},
        {"beams", first_1, "beams, single", 0},        {"beams", first_16, "beams, packets", COHERENT},
        {"shadow", any_1, "shadow, single", 0},        {"shadow", any_16, "shadow, packets", COHERENT},
    };
    size_t hits = 0;
    for (const auto &work : works) {
        const auto rays = read<Input>(folder + "/" + work.rays + ".f32");
        Map map(rays.size());
        work.cast(ground.scene, rays, map, work.flags);
        times.clear();
        for (int round = 0; round < rounds; ++round)
            times.push_back(milliseconds([&] { work.cast(ground.scene, rays, map, work.flags); }));
        print(work.name, times);
        for (uint32_t face : map.face) hits += face != NOTHING;
    }
    std::printf("\"hits\": %zu}\n", hits);
}
