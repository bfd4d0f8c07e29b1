// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// All of libewa.
#ifndef EWA_EWA_H
#define EWA_EWA_H

#include "ewa/acquire.h"
#include "ewa/adjoint.h"
#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/cloud.h"
#include "ewa/cluster.h"
#include "ewa/coloring.h"
#include "ewa/diagnosis.h"
#include "ewa/framing.h"
#include "ewa/furniture.h"
#include "ewa/gaussian.h"
#include "ewa/gaussian_io.h"
#include "ewa/gaussian_render.h"
#include "ewa/gpu.h"
#include "ewa/homogeneous.h"
#include "ewa/image.h"
#include "ewa/io.h"
#include "ewa/lod.h"
#include "ewa/measure.h"
#include "ewa/mesh.h"
#include "ewa/mixture.h"
#include "ewa/model.h"
#include "ewa/options.h"
#include "ewa/panorama.h"
#include "ewa/photos.h"
#include "ewa/prepare.h"
#include "ewa/procedure.h"
#include "ewa/profile.h"
#include "ewa/region.h"
#include "ewa/render.h"
#include "ewa/resample.h"
#include "ewa/scene.h"
#include "ewa/scene_file.h"
#include "ewa/select.h"
#include "ewa/shade.h"
#include "ewa/volume.h"
#include "ewa/volume_render.h"
#include "ewa/warp.h"

#endif
