// SPDX-License-Identifier: Apache-2.0
//
// builtin:atrium, the scene that hone shows itself with: a long court under an open sky between two
// storeys of arcades, in the spirit of the paper's Sponza. It has what the error metrics look for:
// penumbrae of a large lamp on near and far walls, thin iron, masked leaves, a curved mirror with a
// probe, and still water that mirrors at grazing angles.
//
// x runs along the court (30 m), y up, z across (the arcades at |z| = 4, walls at 6.8). Parts that
// meet intersect: no two faces lie in one plane, where a ray could see either.
#include "hone/core/scene/builtin_atrium_parts.h"
#include "hone/core/scene/builtin_scenes.h"
#include "hone/core/scene/builtin_textures.h"

#include <glm/gtc/matrix_transform.hpp>

namespace hone {
namespace {

constexpr uint kBays = 9; ///< arches a side; columns stand between them
constexpr float kBay = 3.0f;
constexpr float kArcade = 4.0f;   ///< |z| of columns and arches
constexpr float kWall = 6.8f;     ///< |z| of the aisles' walls
constexpr float kLowerCap = 3.7f; ///< where the lower arches spring
constexpr float kGallery = 5.55f; ///< the upper floor
constexpr float kUpperCap = 8.15f;
constexpr float kRoof = 9.62f;

float bayCenter(uint bay) {
    return (float(bay) - 0.5f * float(kBays - 1)) * kBay;
}

/// What stands at z < 0 stands turned by 180 degrees at z > 0.
struct Side {
    const char* name;
    float sign;
    [[nodiscard]] mat4 at(float x, float y, float z_out) const {
        return placed({sign * x, y, sign * z_out}, sign > 0 ? 180.0f : 0.0f);
    }
};
constexpr Side kSides[] = {{"north", -1.0f}, {"south", 1.0f}};

struct Materials {
    uint column, wall, vault, trim, planks, tile, dark_tile, grout, iron, terracotta, leaf, wood,
        marble;
    uint cloth[3];
    uint silver, water;
};

Materials addMaterials(Scene& scene) {
    const uint stone = addStoneTexture(scene, {0.62f, 0.55f, 0.44f}, 0.75f, 11);
    const uint pale = addStoneTexture(scene, {0.70f, 0.64f, 0.54f}, 0.55f, 23);
    const uint masonry =
        addMasonryTexture(scene, 4, 8, 0.05f, {0.60f, 0.47f, 0.34f}, {0.36f, 0.31f, 0.26f}, 5);
    const uint brick =
        addMasonryTexture(scene, 6, 16, 0.10f, {0.55f, 0.27f, 0.18f}, {0.52f, 0.46f, 0.39f}, 7);
    const uint marble = addMarbleTexture(scene, {0.60f, 0.53f, 0.43f}, {0.42f, 0.35f, 0.27f}, 3);
    const uint dark = addMarbleTexture(scene, {0.23f, 0.165f, 0.12f}, {0.37f, 0.29f, 0.22f}, 4);
    const uint planks =
        addMasonryTexture(scene, 1, 10, 0.04f, {0.20f, 0.115f, 0.065f}, {0.05f, 0.03f, 0.02f}, 9);
    const uint leaf = addLeafTexture(scene);
    const vec3 gold(0.72f, 0.46f, 0.12f);
    const uint red = addClothTexture(scene, {0.58f, 0.025f, 0.02f}, gold);
    const uint green = addClothTexture(scene, {0.03f, 0.26f, 0.07f}, gold);
    const uint blue = addClothTexture(scene, {0.025f, 0.06f, 0.42f}, {0.66f, 0.62f, 0.54f});

    const auto add = [&](const char* name, Material material, uint flags = 0) {
        material.flags |= flags;
        return addMaterial(scene, name, material);
    };
    Materials m;
    m.column = add("column", diffuse(vec3(1), stone));
    m.wall = add("wall", diffuse(vec3(0.72f), brick));
    m.vault = add("arch", diffuse(vec3(1), masonry));
    m.trim = add("trim", diffuse(vec3(1), pale));
    m.tile = add("pale tile", diffuse(vec3(1), marble));
    m.dark_tile = add("dark tile", diffuse(vec3(1), dark));
    m.planks = add("planks", diffuse(vec3(1), planks));
    m.grout = add("grout", diffuse(vec3(0.12f, 0.10f, 0.08f)));
    m.iron = add("iron", diffuse(vec3(0.035f, 0.035f, 0.04f)));
    m.terracotta = add("terracotta", diffuse(vec3(0.95f, 0.42f, 0.24f), pale));
    m.leaf = add("leaf", diffuse(vec3(1), leaf), kMaterialMasked | kMaterialTwoSided);
    m.wood = add("wood", diffuse(vec3(0.20f, 0.095f, 0.045f)));
    m.marble = add("marble", diffuse(vec3(1.1f * 0.9f), pale));
    m.cloth[0] = add("red cloth", diffuse(vec3(1), red), kMaterialTwoSided);
    m.cloth[1] = add("green cloth", diffuse(vec3(1), green), kMaterialTwoSided);
    m.cloth[2] = add("blue cloth", diffuse(vec3(1), blue), kMaterialTwoSided);
    m.silver = add("silver", mirror(vec3(0.96f, 0.95f, 0.93f)));
    Material water = diffuse(vec3(0.015f, 0.035f, 0.03f));
    water.f0 = vec3(0.04f);
    m.water = add("water", water, kMaterialMirror);
    return m;
}

/// Bevelled tiles in two colours over a bed of grout, wall to wall.
void addFloor(Scene& scene, const Materials& m) {
    constexpr float kTile = 0.75f;
    Shape pale, dark;
    for (uint j = 0; j < 18; ++j)
        for (uint i = 0; i < 40; ++i) {
            const float x = float(i) * kTile - 15.0f, z = float(j) * kTile - 6.75f;
            const float height = 0.003f * chance(i + 64 * j);
            Shape& shape = (i + j) % 2 == 0 ? pale : dark;
            shape.addTile({x + 0.004f, -0.02f, z + 0.004f},
                          {x + kTile - 0.004f, height, z + kTile - 0.004f}, 0.006f);
        }
    pale.projectUvs();
    dark.projectUvs();
    addInstance(scene, "pale tiles", addMesh(scene, pale, m.tile, vec2(3.1f)));
    addInstance(scene, "dark tiles", addMesh(scene, dark, m.dark_tile, vec2(2.3f)));
    Shape bed;
    bed.addQuad({-15.2f, -0.012f, 7}, {15.2f, -0.012f, 7}, {15.2f, -0.012f, -7},
                {-15.2f, -0.012f, -7});
    addInstance(scene, "grout", addMesh(scene, bed, m.grout));
}

/// Columns, arches, floors and walls of both sides.
void addArcades(Scene& scene, const Materials& m) {
    const uint lower_column = addMesh(scene, columnPart(0.30f, kLowerCap, 26), m.column, vec2(2));
    const uint upper_column =
        addMesh(scene, columnPart(0.24f, kUpperCap - kGallery, 22), m.column, vec2(2));
    const uint lower_arch = addMesh(scene, archPart(1.60f), m.vault, vec2(2));
    const uint upper_arch = addMesh(scene, archPart(1.52f), m.vault, vec2(2));
    const uint railing = addMesh(scene, railingPart(2.56f, 14), m.iron);
    const uint dentils = addMesh(scene, dentilPart(10, 0.3f), m.trim, vec2(2));
    const uint floor_band = addMesh(scene, bandPart(30.2f, 0.44f, 0.40f), m.trim, vec2(2));
    const uint roof_band = addMesh(scene, bandPart(30.2f, 0.70f, 0.60f), m.trim, vec2(2));

    // In a side's own coordinates the court lies at +z; the arcade is at z = 0.
    Shape slab, back, piers;
    const float wall = -(kWall - kArcade);
    slab.addBox({-15.1f, 5.2f, wall - 0.2f}, {15.1f, kGallery, 0.30f});
    slab.addBox({-15.1f, kRoof, wall - 0.5f}, {15.1f, kRoof + 0.5f, 0.25f});
    slab.addBox({-15.13f, kRoof + 0.45f, 0.05f}, {15.13f, kRoof + 1.05f, 0.22f});
    back.addBox({-15.2f, -0.1f, wall - 0.4f}, {15.2f, kRoof + 0.3f, wall});
    for (const float end : {-1.0f, 1.0f}) {
        const auto box = [&](float y0, float y1, float inner, float grow) {
            const float a = end * inner, b = end * (15.21f + grow);
            piers.addBox({std::min(a, b), y0, -0.40f - grow}, {std::max(a, b), y1, 0.40f + grow});
        };
        box(-0.06f, kRoof + 0.1f, 13.16f, 0);
        box(kLowerCap - 0.15f, kLowerCap + 0.02f, 13.06f, 0.06f);
        box(kUpperCap - 0.15f, kUpperCap + 0.02f, 13.06f, 0.06f);
        box(-0.07f, 0.17f, 13.04f, 0.08f);
        box(kGallery - 0.05f, kGallery + 0.15f, 13.04f, 0.08f);
    }
    for (uint column = 1; column < kBays; ++column) {
        const float x = bayCenter(column) - 0.5f * kBay;
        back.addBox({x - 0.30f, -0.06f, wall - 0.1f}, {x + 0.30f, kRoof + 0.1f, wall + 0.12f});
    }
    for (Shape* shape : {&slab, &back, &piers})
        shape->projectUvs();
    const uint slab_mesh = addMesh(scene, slab, m.planks, vec2(2));
    const uint back_mesh = addMesh(scene, back, m.wall, vec2(2));
    const uint pier_mesh = addMesh(scene, piers, m.vault, vec2(2));

    for (const Side& side : kSides) {
        const std::string name = side.name;
        const auto place = [&](const char* what, uint mesh, float x, float y, float toward = 0) {
            addInstance(scene, name + " " + what, mesh, side.at(x, y, kArcade - toward));
        };
        place("floors", slab_mesh, 0, 0);
        place("wall", back_mesh, 0, 0);
        place("piers", pier_mesh, 0, 0);
        place("gallery edge", floor_band, 0, 5.17f, 0.62f);
        place("cornice", roof_band, 0, kRoof - 0.05f, 0.72f);
        for (uint column = 1; column < kBays; ++column) {
            const float x = bayCenter(column) - 0.5f * kBay;
            place("lower column", lower_column, x, 0);
            place("upper column", upper_column, x, kGallery);
        }
        for (uint bay = 0; bay < kBays; ++bay) {
            place("lower arch", lower_arch, bayCenter(bay), kLowerCap - 0.02f);
            place("upper arch", upper_arch, bayCenter(bay), kUpperCap - 0.02f);
            place("railing", railing, bayCenter(bay), kGallery);
            place("lower dentils", dentils, bayCenter(bay), 5.04f, 0.46f);
            place("upper dentils", dentils, bayCenter(bay), kRoof - 0.18f, 0.50f);
        }
    }
}

/// The two short walls: a portal on columns, and banners above it.
void addEnds(Scene& scene, const Materials& m) {
    Shape wall, portal, door;
    wall.addBox({-0.4f, -0.12f, -7.05f}, {0, 11.2f, 7.05f});
    portal.addBox({-0.2f, kLowerCap - 0.03f, -2.2f}, {0.92f, 4.15f, 2.2f});
    portal.addBox({-0.21f, 4.10f, -2.35f}, {1.05f, 4.32f, 2.35f});
    portal.addBox({-0.22f, -0.055f, -1.45f}, {0.16f, 3.2f, -1.1f});
    portal.addBox({-0.23f, -0.04f, 1.1f}, {0.15f, 3.2f, 1.45f});
    portal.addBox({-0.24f, 3.15f, -1.5f}, {0.19f, 3.5f, 1.5f});
    // The pediment: a prism along x, its triangular face to the court.
    portal.addQuad({0.9f, 4.25f, 2.3f}, {0.9f, 4.25f, 0}, {0.9f, 5.05f, 0}, {0.9f, 4.27f, 2.3f});
    portal.addQuad({0.9f, 4.25f, 0}, {0.9f, 4.25f, -2.3f}, {0.9f, 4.27f, -2.3f}, {0.9f, 5.05f, 0});
    portal.addQuad({-0.2f, 4.27f, 2.3f}, {0.9f, 4.27f, 2.3f}, {0.9f, 5.05f, 0}, {-0.2f, 5.05f, 0});
    portal.addQuad({0.9f, 4.27f, -2.3f}, {-0.2f, 4.27f, -2.3f}, {-0.2f, 5.05f, 0},
                   {0.9f, 5.05f, 0});
    for (const float z : {-0.55f, 0.55f})
        for (uint panel = 0; panel < 3; ++panel)
            door.addBox({0.02f, 0.18f + float(panel), z - 0.38f},
                        {0.09f, 1.02f + float(panel), z + 0.38f});
    door.addBox({-0.25f, -0.03f, -1.2f}, {0.05f, 3.17f, 1.2f});
    for (Shape* shape : {&wall, &portal, &door})
        shape->projectUvs();

    const uint wall_mesh = addMesh(scene, wall, m.wall, vec2(2));
    const uint portal_mesh = addMesh(scene, portal, m.trim, vec2(2));
    const uint door_mesh = addMesh(scene, door, m.wood);
    const uint column = addMesh(scene, columnPart(0.27f, kLowerCap, 24), m.column, vec2(2));
    const uint banner = addMesh(scene, bannerPart(1.5f, 4.2f), m.cloth[0], vec2(1.5f));
    const uint side_banner = addMesh(scene, bannerPart(1.2f, 3.4f), m.cloth[2], vec2(1.2f));
    for (const float end : {-1.0f, 1.0f}) {
        const mat4 here = placed({end * 15.0f, 0, 0}, end > 0 ? 180.0f : 0.0f);
        const auto place = [&](const char* what, uint mesh, mat4 local = mat4(1)) {
            addInstance(scene, std::string(end < 0 ? "west " : "east ") + what, mesh, here * local);
        };
        place("wall", wall_mesh);
        place("portal", portal_mesh);
        place("door", door_mesh);
        place("portal column", column, placed({0.45f, 0, -1.85f}));
        place("portal column", column, placed({0.45f, 0, 1.85f}));
        place("banner", banner, placed({0.15f, 10.3f, 0}, 90));
        place("side banner", side_banner, placed({0.15f, 10.0f, -2.2f}, 90));
        place("side banner", side_banner, placed({0.15f, 10.0f, 2.2f}, 90));
    }
}

/// Curtains, plants and hanging bowls in the bays, in turn.
void addFurnishings(Scene& scene, const Materials& m) {
    uint curtain[3];
    for (uint i = 0; i < 3; ++i)
        curtain[i] = addMesh(scene, curtainPart(2.36f, 3.3f), m.cloth[i], vec2(0.8f));
    const uint rod = addMesh(scene, curtainRodPart(2.50f), m.iron);
    const uint pot = addMesh(scene, potPart(), m.terracotta);
    const uint leaves = addMesh(scene, leavesPart(54, 0.95f, 0.54f, 1), m.leaf);
    const uint tufts = addMesh(scene, leavesPart(34, 0.48f, 0.26f, 2), m.leaf);
    const uint bowl = addMesh(scene, hangingBowlPart(1.75f), m.terracotta);
    const uint chains = addMesh(scene, hangingChainsPart(1.75f), m.iron);

    for (const Side& side : kSides)
        for (uint bay = 0; bay < kBays; ++bay) {
            const float x = bayCenter(bay);
            const std::string name = side.name;
            if (bay % 2 == 1) {
                const uint color = (bay / 2 + (side.sign > 0 ? 1 : 0)) % 3;
                const mat4 at = side.at(x, kLowerCap - 0.24f, kArcade);
                addInstance(scene, name + " curtain", curtain[color], at);
                addInstance(scene, name + " rod", rod, at);
            } else {
                const mat4 at = side.at(x, kLowerCap + 1.09f, kArcade);
                addInstance(scene, name + " chains", chains, at);
                addInstance(scene, name + " bowl", bowl, at);
                addInstance(scene, name + " tuft", tufts, at * placed({0, -1.75f, 0}, 40.0f * x));
                const mat4 pot_at = side.at(x, 0, 3.15f) * placed({0, 0, 0}, 77.0f * x);
                addInstance(scene, name + " pot", pot, pot_at);
                addInstance(scene, name + " leaves", leaves, pot_at);
            }
            // Above, shorter curtains in every third bay.
            if (bay % 3 == 1) {
                const mat4 at = side.at(x, kUpperCap - 0.20f, kArcade + 0.1f) *
                                glm::scale(mat4(1), vec3(1, 0.70f, 1));
                addInstance(scene, name + " upper curtain", curtain[(bay / 3 + 2) % 3], at);
                addInstance(scene, name + " upper rod", rod, at);
            }
        }
}

/// The basin in the middle of the court with the mirror knot, and the probe in the knot's centre.
void addFountain(Scene& scene, const Materials& m) {
    constexpr float kKnot = 0.95f, kFoot = 1.15f;
    addInstance(scene, "basin", addMesh(scene, basinPart(2.1f, 0.52f), m.marble, vec2(2)));
    addInstance(scene, "pedestal", addMesh(scene, pedestalPart(kFoot), m.marble, vec2(2)));
    Shape surface;
    const vec2 disc[] = {{1.80f, 0.37f}, {0, 0.37f}};
    surface.addLathe(disc, 72);
    const uint water = addInstance(scene, "water", addMesh(scene, surface, m.water));
    // The lowest lobe stands a little inside of the foot.
    const vec3 center(0, kFoot + kKnot - 0.015f, 0);
    const uint knot =
        addInstance(scene, "knot", addMesh(scene, knotPart(kKnot), m.silver), placed(center, 24));
    scene.probes.push_back({center, knot});
    scene.instances[knot].probe = 0;
    scene.task_objects = {knot};
    scene.instances[water].probe = 0;
}

} // namespace

Scene atriumScene() {
    Scene scene;
    const Materials materials = addMaterials(scene);
    addFloor(scene, materials);
    addArcades(scene, materials);
    addEnds(scene, materials);
    addFurnishings(scene, materials);
    addFountain(scene, materials);

    // A lamp of 2 x 2 m as a low sun: 27 m up, half a metre of penumbra behind a near column.
    const vec3 lamp(6.0f, 27.0f, 8.5f);
    const vec3 toward = normalize(vec3(0, 3, -2) - lamp);
    const vec3 half_u = normalize(cross(toward, vec3(1, 0, 0)));
    scene.lights.push_back(
        rectangleLight(lamp, half_u, cross(toward, half_u), vec3(1.0f, 0.86f, 0.66f) * 1150.0f));
    scene.environment = {.zenith = {0.28f, 0.52f, 1.05f},
                         .horizon = {0.95f, 0.98f, 1.0f},
                         .ground = {0.30f, 0.25f, 0.19f},
                         .ambient = {0.235f, 0.235f, 0.25f}};
    scene.cameras = {{.name = "court",
                      .position = {-12.6f, 1.9f, 1.9f},
                      .target = {1.0f, 3.0f, -0.9f},
                      .fov_y_degrees = 62},
                     {.name = "gallery",
                      .position = {-7.0f, 7.85f, 4.9f},
                      .target = {0.3f, 3.5f, -1.7f},
                      .fov_y_degrees = 62},
                     {.name = "mirror",
                      .position = {-2.5f, 2.3f, 1.7f},
                      .target = {0.0f, 1.95f, 0.0f},
                      .fov_y_degrees = 50},
                     {.name = "lens",
                      .position = {-4.3f, 2.2f, 2.6f},
                      .target = {0.0f, 1.95f, 0.0f},
                      .fov_y_degrees = 45,
                      .aperture = 0.15f,
                      .focus = 5.0f}};
    // From the court past the mirror, rising.
    const auto key = [](float time, vec3 position, vec3 target) {
        return CameraKey{
            time, {.name = "walk", .position = position, .target = target, .fov_y_degrees = 62}};
    };
    scene.paths = {{.name = "walk",
                    .keys = {key(0, {-12.6f, 1.9f, 1.9f}, {1.0f, 3.0f, -0.9f}),
                             key(2, {-8.0f, 2.0f, 1.0f}, {1.0f, 2.6f, -0.6f}),
                             key(4, {-4.2f, 2.4f, 2.2f}, {0.0f, 2.0f, 0.0f}),
                             key(6, {-1.8f, 3.4f, 3.4f}, {0.3f, 2.0f, -0.4f})}}};
    return scene;
}

} // namespace hone
