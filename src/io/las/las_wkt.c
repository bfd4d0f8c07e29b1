// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Well-known text of coordinate reference systems that clouds name by their codes, which point formats from 6 on must have
// where older ones have GeoTIFF keys: longitudes and latitudes, zones of UTM and MGA, and single grids in which surveys come.
//
// Based on: OGC 01-009, "Coordinate Transformation Services", section 7; the EPSG Geodetic Parameter Dataset, 2023.
#include "io/las/las_wkt.h"
#include "base/format.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Systems of longitude and latitude, in degrees from Greenwich.
typedef struct geographic_system {
    uint16_t code;
    const char *name, *datum;
    uint16_t datum_code;
    const char *spheroid; ///< what stands in SPHEROID[...]
} geographic_system;

#define GRS_1980 "\"GRS 1980\",6378137,298.257222101,AUTHORITY[\"EPSG\",\"7019\"]"
#define BESSEL_1841 "\"Bessel 1841\",6377397.155,299.1528128,AUTHORITY[\"EPSG\",\"7004\"]"

static const geographic_system geographic_systems[] = {
    {4326, "WGS 84", "WGS_1984", 6326, "\"WGS 84\",6378137,298.257223563,AUTHORITY[\"EPSG\",\"7030\"]"},
    {4258, "ETRS89", "European_Terrestrial_Reference_System_1989", 6258, GRS_1980},
    {4269, "NAD83", "North_American_Datum_1983", 6269, GRS_1980},
    {4171, "RGF93 v1", "Reseau_Geodesique_Francais_1993_v1", 6171, GRS_1980},
    {4150, "CH1903+", "CH1903+", 6150, BESSEL_1841},
    {4277, "OSGB36", "Ordnance_Survey_of_Great_Britain_1936", 6277,
     "\"Airy 1830\",6377563.396,299.3249646,AUTHORITY[\"EPSG\",\"7001\"]"},
    {4289, "Amersfoort", "Amersfoort", 6289, BESSEL_1841},
    {4619, "SWEREF99", "SWEREF99", 6619, GRS_1980},
    {4167, "NZGD2000", "New_Zealand_Geodetic_Datum_2000", 6167, GRS_1980},
    {4283, "GDA94", "Geocentric_Datum_of_Australia_1994", 6283, GRS_1980},
    {7844, "GDA2020", "Geocentric_Datum_of_Australia_2020", 1168, GRS_1980},
};

/// Transverse Mercator in zones 6 degrees wide: code `zero_code` + zone.
typedef struct zone_family {
    uint16_t zero_code;
    uint8_t first_zone, last_zone;
    uint16_t geographic_code;
    const char *name; ///< before the zone's number
    const char *suffix;
    bool south;
} zone_family;

static const zone_family zone_families[] = {
    {32600, 1, 60, 4326, "WGS 84 / UTM zone ", "N", false}, {32700, 1, 60, 4326, "WGS 84 / UTM zone ", "S", true},
    {25800, 28, 37, 4258, "ETRS89 / UTM zone ", "N", false}, {26900, 1, 23, 4269, "NAD83 / UTM zone ", "N", false},
    {28300, 48, 58, 4283, "GDA94 / MGA zone ", "", true},    {7800, 46, 59, 7844, "GDA2020 / MGA zone ", "", true},
};

/// Grids of one country, in metres.
typedef struct single_grid {
    uint16_t code, geographic_code;
    const char *name, *projection, *origin; ///< origin: PARAMETERs before the false easting
    double easting, northing;
} single_grid;

#define MERCATOR "Transverse_Mercator"
#define MERCATOR_AT(latitude, longitude, scale)                                                                                    \
    "PARAMETER[\"latitude_of_origin\"," latitude "],PARAMETER[\"central_meridian\"," longitude "],PARAMETER[\"scale_factor\","     \
    scale "]"

static const single_grid single_grids[] = {
    {2154, 4171, "RGF93 v1 / Lambert-93", "Lambert_Conformal_Conic_2SP",
     "PARAMETER[\"latitude_of_origin\",46.5],PARAMETER[\"central_meridian\",3],PARAMETER[\"standard_parallel_1\",49],"
     "PARAMETER[\"standard_parallel_2\",44]",
     700000, 6600000},
    {2056, 4150, "CH1903+ / LV95", "Hotine_Oblique_Mercator_Azimuth_Center",
     "PARAMETER[\"latitude_of_center\",46.9524055555556],PARAMETER[\"longitude_of_center\",7.43958333333333],"
     "PARAMETER[\"azimuth\",90],PARAMETER[\"rectified_grid_angle\",90],PARAMETER[\"scale_factor\",1]",
     2600000, 1200000},
    {27700, 4277, "OSGB36 / British National Grid", MERCATOR, MERCATOR_AT("49", "-2", "0.9996012717"), 400000, -100000},
    {28992, 4289, "Amersfoort / RD New", "Oblique_Stereographic",
     MERCATOR_AT("52.1561605555556", "5.38763888888889", "0.9999079"), 155000, 463000},
    {3067, 4258, "ETRS89 / TM35FIN(E,N)", MERCATOR, MERCATOR_AT("0", "27", "0.9996"), 500000, 0},
    {3006, 4619, "SWEREF99 TM", MERCATOR, MERCATOR_AT("0", "15", "0.9996"), 500000, 0},
    {2193, 4167, "NZGD2000 / New Zealand Transverse Mercator 2000", MERCATOR, MERCATOR_AT("0", "173", "0.9996"), 1600000,
     10000000},
};

/// Systems of heights, in metres but for one.
typedef struct vertical_system {
    uint16_t code;
    const char *name, *datum;
    uint16_t datum_code;
    bool us_feet;
} vertical_system;

static const vertical_system vertical_systems[] = {
    {5703, "NAVD88 height", "North American Vertical Datum 1988", 5103, false},
    {6360, "NAVD88 height (ftUS)", "North American Vertical Datum 1988", 5103, true},
    {5773, "EGM96 height", "EGM96 geoid", 5171, false},
    {3855, "EGM2008 height", "EGM2008 geoid", 1027, false},
    {5621, "EVRF2007 height", "European Vertical Reference Frame 2007", 5215, false},
    {5701, "ODN height", "Ordnance Datum Newlyn", 5101, false},
    {5709, "NAP height", "Normaal Amsterdams Peil", 5109, false},
    {5711, "AHD height", "Australian Height Datum", 5111, false},
    {5720, "NGF-IGN69 height", "Nivellement General de la France - IGN69", 5119, false},
    {5728, "LN02 height", "Landesnivellement 1902", 5127, false},
    {5783, "DHHN92 height", "Deutsches Haupthoehennetz 1992", 5181, false},
    {7837, "DHHN2016 height", "Deutsches Haupthoehennetz 2016", 1170, false},
    {5613, "RH2000 height", "Rikets hojdsystem 2000", 5208, false},
    {5941, "NN2000 height", "Norway Normal Null 2000", 1096, false},
};

#define COUNT_OF(table) (sizeof(table) / sizeof(table)[0])

enum { PART_BYTES = 1024 };
_Static_assert(3 * PART_BYTES < EWA_LAS_WKT_BYTES, "all parts fit together");

static bool geographic_text(unsigned code, char text[PART_BYTES]) {
    for (size_t i = 0; i < COUNT_OF(geographic_systems); i++) {
        const geographic_system *s = &geographic_systems[i];
        if (s->code != code) continue;
        snprintf(text, PART_BYTES,
                 "GEOGCS[\"%s\",DATUM[\"%s\",SPHEROID[%s],AUTHORITY[\"EPSG\",\"%u\"]],PRIMEM[\"Greenwich\",0,"
                 "AUTHORITY[\"EPSG\",\"8901\"]],UNIT[\"degree\",0.0174532925199433,AUTHORITY[\"EPSG\",\"9122\"]],"
                 "AUTHORITY[\"EPSG\",\"%u\"]]",
                 s->name, s->datum, s->spheroid, s->datum_code, s->code);
        return true;
    }
    return false;
}

/// Writes a projected system and its name.
static bool write_projected(unsigned code, const single_grid *grid, char name[PART_BYTES], char text[2 * PART_BYTES]) {
    char geographic[PART_BYTES];
    if (!geographic_text(grid->geographic_code, geographic)) return false;
    snprintf(name, PART_BYTES, "%s", grid->name);
    const int length =
        ewa_format(text, 2 * PART_BYTES,
                 "PROJCS[\"%s\",%s,PROJECTION[\"%s\"],%s,PARAMETER[\"false_easting\",%.0f],PARAMETER[\"false_northing\",%.0f],"
                 "UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH],"
                 "AUTHORITY[\"EPSG\",\"%u\"]]",
                 grid->name, geographic, grid->projection, grid->origin, grid->easting, grid->northing, code);
    return length > 0 && length < 2 * PART_BYTES;
}

static bool zone_text(unsigned code, char name[PART_BYTES], char text[2 * PART_BYTES]) {
    for (size_t i = 0; i < COUNT_OF(zone_families); i++) {
        const zone_family *f = &zone_families[i];
        if (code < (unsigned)f->zero_code + f->first_zone || code > (unsigned)f->zero_code + f->last_zone) continue;
        const unsigned zone = code - f->zero_code;
        char origin[PART_BYTES], said[64];
        snprintf(said, sizeof said, "%s%u%s", f->name, zone, f->suffix);
        snprintf(origin, sizeof origin, MERCATOR_AT("0", "%d", "0.9996"), 6 * (int)zone - 183);
        const single_grid grid = {.geographic_code = f->geographic_code,
                                  .name = said,
                                  .projection = MERCATOR,
                                  .origin = origin,
                                  .easting = 500000,
                                  .northing = f->south ? 10000000 : 0};
        return write_projected(code, &grid, name, text);
    }
    return false;
}

static bool horizontal_text(unsigned code, char name[PART_BYTES], char text[2 * PART_BYTES]) {
    for (size_t i = 0; i < COUNT_OF(single_grids); i++)
        if (single_grids[i].code == code) return write_projected(code, &single_grids[i], name, text);
    if (zone_text(code, name, text)) return true;
    if (!geographic_text(code, text)) return false;
    // The name is the first quoted part.
    snprintf(name, PART_BYTES, "%.*s", (int)strcspn(text + sizeof "GEOGCS[", "\""), text + sizeof "GEOGCS[");
    return true;
}

static const vertical_system *find_vertical(unsigned code) {
    for (size_t i = 0; i < COUNT_OF(vertical_systems); i++)
        if (vertical_systems[i].code == code) return &vertical_systems[i];
    return NULL;
}

bool ewa_las_wkt_make(const char *codes, char text[EWA_LAS_WKT_BYTES]) {
    char *end, name[PART_BYTES], horizontal[2 * PART_BYTES];
    const unsigned long code = strtoul(codes, &end, 10);
    const unsigned long height_code = *end == '+' ? strtoul(end + 1, &end, 10) : 0;
    if (*end || code > UINT16_MAX || height_code > UINT16_MAX || !horizontal_text((unsigned)code, name, horizontal)) return false;
    const vertical_system *vertical = find_vertical((unsigned)height_code);
    if (height_code && !vertical) return false;
    if (!vertical) {
        snprintf(text, EWA_LAS_WKT_BYTES, "%s", horizontal);
        return true;
    }
    const int length =
        snprintf(text, EWA_LAS_WKT_BYTES,
                 "COMPD_CS[\"%s + %s\",%s,VERT_CS[\"%s\",VERT_DATUM[\"%s\",2005,AUTHORITY[\"EPSG\",\"%u\"]],%s,"
                 "AXIS[\"Gravity-related height\",UP],AUTHORITY[\"EPSG\",\"%u\"]]]",
                 name, vertical->name, horizontal, vertical->name, vertical->datum, vertical->datum_code,
                 vertical->us_feet ? "UNIT[\"US survey foot\",0.304800609601219,AUTHORITY[\"EPSG\",\"9003\"]]"
                                   : "UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]]",
                 vertical->code);
    return length > 0 && length < EWA_LAS_WKT_BYTES;
}
