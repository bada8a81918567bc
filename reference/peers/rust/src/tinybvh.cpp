// tinybvh, one header of C++, by four functions of C. The wrapper in tinybvh-rs is not asked: its rays have 64 bytes and the header's
// more, so that a call writes beyond them.
#define TINYBVH_IMPLEMENTATION
#include <tiny_bvh.h>

#include <vector>

using namespace tinybvh;

namespace {

struct Single {
    std::vector<bvhvec4> corners;
    BVH tree;
};

struct Double {
    std::vector<bvhdbl3> corners;
    BVH_Double tree;
};

}  // namespace

extern "C" {

// Three corners of three numbers each for each of `count` faces. The tree is never freed: the program ends with its question.
void* tinybvh_single(const double* corners, size_t count) {
    auto* made = new Single;
    for (size_t k = 0; k < 3 * count; ++k) {
        const double* p = corners + 3 * k;
        made->corners.emplace_back(float(p[0]), float(p[1]), float(p[2]), 0.0f);
    }
    made->tree.Build(made->corners.data(), uint32_t(count));
    return made;
}

void* tinybvh_double(const double* corners, size_t count) {
    auto* made = new Double;
    for (size_t k = 0; k < 3 * count; ++k) {
        const double* p = corners + 3 * k;
        made->corners.emplace_back(p[0], p[1], p[2]);
    }
    made->tree.Build(made->corners.data(), uint64_t(count));
    return made;
}

// The face of the first hit, and its t; -1: no hit.
int64_t tinybvh_single_first(const void* made, const double* o, const double* d, double* t) {
    Ray ray{bvhvec3{float(o[0]), float(o[1]), float(o[2])}, bvhvec3{float(d[0]), float(d[1]), float(d[2])}};
    static_cast<const Single*>(made)->tree.Intersect(ray);
    *t = ray.hit.t;
    return ray.hit.t < BVH_FAR ? int64_t(ray.hit.prim) : -1;
}

int64_t tinybvh_double_first(const void* made, const double* o, const double* d, double* t) {
    RayEx ray{bvhdbl3{o[0], o[1], o[2]}, bvhdbl3{d[0], d[1], d[2]}};
    static_cast<const Double*>(made)->tree.Intersect(ray);
    *t = ray.hit.t;
    return ray.hit.t < BVH_DBL_FAR ? int64_t(ray.hit.prim) : -1;
}

// Its version: major, minor, sub.
void tinybvh_version(uint32_t* version) {
    version[0] = TINY_BVH_VERSION_MAJOR, version[1] = TINY_BVH_VERSION_MINOR, version[2] = TINY_BVH_VERSION_SUB;
}
}
