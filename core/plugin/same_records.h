// SPDX-License-Identifier: Apache-2.0
//
// Proof that the records of the plug-in border are the bytes of hone's own, so that arrays cross it
// as they are. A change of scene.glsl.h or ray.glsl.h that breaks this is a new major version of
// the border.
#pragma once

#include "hone/core/plugin/hone_pass.h"
#include "hone/core/plugin/hone_plugin.h"
#include "hone/core/scene/scene.h"
#include "hone/core/trace/ray.glsl.h"

#include <cstddef>
#include <type_traits>

namespace hone {

/// Members of the same name at the same place, of the same size.
#define HONE_SAME_MEMBER(Ours, Theirs, member)                                                     \
    static_assert(offsetof(Ours, member) == offsetof(Theirs, member) &&                            \
                  sizeof(Ours::member) == sizeof(Theirs::member))

static_assert(sizeof(Ray) == sizeof(hone_ray));
HONE_SAME_MEMBER(Ray, hone_ray, origin);
HONE_SAME_MEMBER(Ray, hone_ray, tmin);
HONE_SAME_MEMBER(Ray, hone_ray, direction);
HONE_SAME_MEMBER(Ray, hone_ray, tmax);

static_assert(sizeof(Hit) == sizeof(hone_hit));
HONE_SAME_MEMBER(Hit, hone_hit, instance);
HONE_SAME_MEMBER(Hit, hone_hit, primitive);

static_assert(sizeof(Mesh) == sizeof(hone_mesh));
HONE_SAME_MEMBER(Mesh, hone_mesh, first_triangle);
HONE_SAME_MEMBER(Mesh, hone_mesh, triangle_count);
HONE_SAME_MEMBER(Mesh, hone_mesh, material);
HONE_SAME_MEMBER(Mesh, hone_mesh, first_cluster);
HONE_SAME_MEMBER(Mesh, hone_mesh, cluster_count);

static_assert(sizeof(Instance) == sizeof(hone_instance));
HONE_SAME_MEMBER(Instance, hone_instance, to_world);
HONE_SAME_MEMBER(Instance, hone_instance, normal_matrix);
HONE_SAME_MEMBER(Instance, hone_instance, mesh);
HONE_SAME_MEMBER(Instance, hone_instance, probe);
HONE_SAME_MEMBER(Instance, hone_instance, flipped);

static_assert(sizeof(Material) == sizeof(hone_material));
HONE_SAME_MEMBER(Material, hone_material, base_color);
HONE_SAME_MEMBER(Material, hone_material, base_color_texture);
HONE_SAME_MEMBER(Material, hone_material, emission);
HONE_SAME_MEMBER(Material, hone_material, alpha);
HONE_SAME_MEMBER(Material, hone_material, f0);
HONE_SAME_MEMBER(Material, hone_material, alpha_cutoff);
HONE_SAME_MEMBER(Material, hone_material, flags);

static_assert(sizeof(Texture) == sizeof(hone_texture));
HONE_SAME_MEMBER(Texture, hone_texture, first_texel);
HONE_SAME_MEMBER(Texture, hone_texture, width);
HONE_SAME_MEMBER(Texture, hone_texture, height);
HONE_SAME_MEMBER(Texture, hone_texture, levels);
HONE_SAME_MEMBER(Texture, hone_texture, wrap_u);
HONE_SAME_MEMBER(Texture, hone_texture, wrap_v);

static_assert(sizeof(Camera) == sizeof(hone_camera));
HONE_SAME_MEMBER(Camera, hone_camera, position);
HONE_SAME_MEMBER(Camera, hone_camera, forward);
HONE_SAME_MEMBER(Camera, hone_camera, right);
HONE_SAME_MEMBER(Camera, hone_camera, up);
HONE_SAME_MEMBER(Camera, hone_camera, tan_half_fov_y);
HONE_SAME_MEMBER(Camera, hone_camera, near);
HONE_SAME_MEMBER(Camera, hone_camera, lens_radius);
HONE_SAME_MEMBER(Camera, hone_camera, focus);

#undef HONE_SAME_MEMBER

static_assert(sizeof(vec3) == sizeof(float[3]) && sizeof(vec2) == sizeof(float[2]) &&
              sizeof(uvec3) == sizeof(std::uint32_t[3]) && std::is_same_v<uint, std::uint32_t>);
static_assert(kNone == HONE_NONE && kMaterialTwoSided == HONE_MATERIAL_TWO_SIDED &&
              kMaterialMasked == HONE_MATERIAL_MASKED && kMaterialMirror == HONE_MATERIAL_MIRROR);

} // namespace hone
