// SPDX-License-Identifier: Apache-2.0
//
// The vocabulary of a kernel: a source in the common subset of GLSL and C++ (GLM), built once to
// SPIR-V and once to native code. A kernel file holds
//
//     struct Params { uint mode; float gain; };
//     HONE_PARAMS(Params)
//     HONE_READ(vec2, error)                   // a port, by the name it has in the graph
//     HONE_WRITE(vec2, combined)
//     void kernel(uint index) { combined[index] = params.gain * error[index]; }
//
// and nothing else: kernel() runs once for each index below the dispatch count. In C++ the file is
// included inside a struct derived from hone::HostKernel (host_kernel.h), so buffers are members
// and functions are methods.
//
// A port that takes several edges is HONE_READS(vec2, errors, 8), read as errors[k].data[index].
//
// The subset: write 1.0f, never 1.0; vec3(v) to shorten a vector, no swizzles of more than one
// component; no array constructors; HONE_OUT / HONE_INOUT for parameters; HONE_CONST for constants;
// a variable has its own statement; HONE_FLAT before a kernel whose calls shall all be inlined on
// the host, where it then keeps its records in registers (measure: most kernels gain nothing and
// get large); HONE_PRECISE before one whose sums and products must not be fused, because the
// result's sign or last bit decides something. Results are the same bits at any thread count
// because an invocation may write only its own elements.
#ifndef HONE_KERNEL_GLSL_H
#define HONE_KERNEL_GLSL_H

#ifdef __cplusplus

#include "hone/core/device/host_kernel.h"

#define HONE_PARAMS(Type) Type params = parameters<Type>();
#define HONE_READ(type, name) const ::hone::HostArray<const type> name = array<const type>(#name);
#define HONE_WRITE(type, name) const ::hone::HostArray<type> name = array<type>(#name);
#define HONE_READS(type, name, elements)                                                           \
    const ::hone::HostArrays<const type, elements> name = arrays<const type, elements>(#name);
#define HONE_OUT(type) type&
#define HONE_INOUT(type) type&
#define HONE_CONST static constexpr
#define HONE_FLAT [[gnu::flatten]]
#define HONE_PRECISE

#else

#define HONE_PARAMS(Type)                                                                          \
    layout(push_constant, scalar) uniform HoneParams {                                             \
        uint hone_count;                                                                           \
        uint hone_row;                                                                             \
        Type params;                                                                               \
    };
// clang-format off
#define HONE_READ(type, name) layout(scalar) readonly restrict buffer name##_buffer { type name[]; };
#define HONE_WRITE(type, name) layout(scalar) restrict buffer name##_buffer { type name[]; };
#define HONE_READS(type, name, elements) layout(scalar) readonly restrict buffer name##_buffer { type data[]; } name[elements];
// clang-format on
#define HONE_OUT(type) out type
#define HONE_INOUT(type) inout type
#define HONE_CONST const
#define HONE_FLAT
#define HONE_PRECISE precise

#endif
#endif
