// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Arrays of VTK's XML files, whatever the file holds: numbers as text, in base64 within the array or appended, raw or
// packed by zlib, LZ4 or LZMA.
#ifndef EWA_SRC_VTK_XML_H
#define EWA_SRC_VTK_XML_H

#include "io/source.h"
#include "io/volume/xml_tags.h"

enum { EWA_VTK_ATTRIBUTE_BYTES = 256 };

/// What a file says of its arrays.
typedef struct ewa_vtk_xml {
    ewa_context *context;
    const char *name, *kind; ///< of the file and of its format, for messages
    const char *text, *end;
    bool has_root, wide, packed, big_endian; ///< `wide`: sizes in front of numbers have 64 bits
    const struct ewa_vtk_packing *packing;   ///< of what is packed; NULL: by zlib, or by what is not known
    bool has_appended, raw;                  ///< `raw`: the appended data are bytes, in which no tag is looked for
    bool ends;                               ///< with </VTKFile>
    ewa_xml_tag root, appended;
} ewa_vtk_xml;

/// The numbers of an array as the file has them.
typedef struct ewa_vtk_stored {
    ewa_packing packing;
    const uint8_t *bytes; ///< of the file, or the same as `owned`
    size_t size_bytes;
    uint8_t *owned; ///< memory of the context, of size_bytes; NULL: the file's
    size_t owned_bytes;
} ewa_vtk_stored;

/// Looks through the tags for the root and for appended data; `xml` has its first four members. Without a root,
/// has_root is false.
void ewa_vtk_xml_open(ewa_vtk_xml *xml, const uint8_t *bytes, size_t size_bytes);

/// Copies an attribute's value; false when there is none or it is longer.
bool ewa_vtk_attribute(const ewa_xml_tag *tag, const char *name, char value[EWA_VTK_ATTRIBUTE_BYTES]);

/// Reports that something cannot be read; returns EWA_ERROR_FORMAT.
ewa_status ewa_vtk_broken(const ewa_vtk_xml *xml, const char *what, const char *text);

/// Finds the numbers of a DataArray. What sizes claim is compared with the bytes that there are. `stored->owned` is to be
/// released by the caller. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (a compressor that is none of these),
/// EWA_ERROR_MEMORY.
ewa_status ewa_vtk_xml_find(const ewa_vtk_xml *xml, const ewa_xml_tag *array, ewa_vtk_stored *stored);

#endif
