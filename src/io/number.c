// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers as decimal text, by exact integer arithmetic.
//
// Reading and writing meet in one question: what is w * 10^e in binary? It is answered as 64 leading bits, an
// exponent of two, and whether anything non-zero follows (`scaled`); rounding that once is exact. Three ways
// lead there, the cheapest that is exact is taken:
//   - both w and 10^|e| are doubles: one floating-point operation rounds correctly;
//   - |e| <= 27: 5^|e| has 63 bits, and 128-bit integers hold the product or the quotient;
//   - else: long integers of 32-bit limbs.
//
// Based on: W. D. Clinger, "How to Read Floating Point Numbers Accurately", PLDI 1990, section 3 (the first
// path). D. E. Knuth, "The Art of Computer Programming", volume 2, 3rd edition 1997, section 4.3.1, algorithm
// D (division).
#include "io/number.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    MAX_EXACT_POWER = 22,   // 10^22 is the largest power of ten that is a double
    MAX_SMALL_POWER = 27,   // 5^27 < 2^63
    MAX_DIGITS = 800,       // 767 digits decide the rounding of any double; more only say "not zero"
    LIMBS = 192,            // 10^(800 + 400) has 125 limbs, and a division needs 3 more
    DECIMAL_INFINITE = 310, // 10^310 is beyond any double, 10^-345 below half of the least one
    DECIMAL_ZERO = -345,
    EXPONENT_BOUND = 1 << 20, // larger exponents mean the same; keeps sums small
};

/// An IEEE 754 format by its bits: stored fraction bits and the exponent of the smallest positive number.
typedef struct format {
    int fraction_bits, min_exponent;
    uint64_t infinity_bits;
} format;

static const format binary64 = {52, -1074, 0x7ff0000000000000u};
static const format binary32 = {23, -149, 0x7f800000u};

/// leading * 2^exponent, leading in [2^63, 2^64), plus less than 2^exponent when `more`.
typedef struct scaled {
    uint64_t leading;
    int exponent;
    bool more;
} scaled;

/// Decimal text taken apart: value = digits * 10^exponent, exact unless `cut`.
typedef struct decimal {
    uint64_t digits;
    int64_t exponent;
    bool negative, cut;
    const char *first, *last; // first digit, and the end of digits and point
    int64_t written_exponent; // what stands after 'e'
} decimal;

// clang-format off
static const uint64_t powers_of_5[MAX_SMALL_POWER + 1] = {
    1, 5, 25, 125, 625, 3125, 15625, 78125, 390625, 1953125, 9765625, 48828125, 244140625, 1220703125,
    6103515625, 30517578125, 152587890625, 762939453125, 3814697265625, 19073486328125, 95367431640625,
    476837158203125, 2384185791015625, 11920928955078125, 59604644775390625, 298023223876953125,
    1490116119384765625, 7450580596923828125,
};
// clang-format on

static const double powers_of_10[MAX_EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                         1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                         1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static const uint64_t small_powers_of_10[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};

// ---- long integers ---------------------------------------------------------------------------------------

/// A natural number, least limb first, without leading zero limbs.
typedef struct natural {
    uint32_t limb[LIMBS];
    int count;
} natural;

/// n = n * factor + addend
static void multiply_add(natural *n, uint32_t factor, uint32_t addend) {
    uint64_t carry = addend;
    for (int i = 0; i < n->count; i++) {
        carry += (uint64_t)n->limb[i] * factor;
        n->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry) n->limb[n->count++] = (uint32_t)carry;
}

static void multiply_power_of_5(natural *n, int power) {
    for (; power >= 13; power -= 13) multiply_add(n, (uint32_t)powers_of_5[13], 0);
    multiply_add(n, (uint32_t)powers_of_5[power], 0);
}

static int bit_length(const natural *n) { return 32 * n->count - __builtin_clz(n->limb[n->count - 1]); }

static void shift_left(natural *n, int bits) {
    const int limbs = bits / 32, rest = bits % 32;
    for (int i = n->count; i >= 0; i--) {
        const uint32_t high = i < n->count ? n->limb[i] : 0, low = i > 0 ? n->limb[i - 1] : 0;
        n->limb[i + limbs] = rest ? high << rest | low >> (32 - rest) : high;
    }
    memset(n->limb, 0, (size_t)limbs * sizeof n->limb[0]);
    n->count += limbs + 1;
    while (n->count && n->limb[n->count - 1] == 0) n->count--;
}

static scaled normalise(unsigned __int128 n, int exponent, bool more) {
    const uint64_t high = (uint64_t)(n >> 64);
    const int zeros = high ? __builtin_clzll(high) : 64 + __builtin_clzll((uint64_t)n);
    n <<= zeros;
    return (scaled){(uint64_t)(n >> 64), exponent + 64 - zeros, more || (uint64_t)n != 0};
}

/// Subtracts q * divisor from the limbs of `rest` that start at `at`; returns whether the result is negative.
static bool subtract_product(natural *rest, int at, const natural *divisor, uint32_t q) {
    uint64_t carry = 0;
    int64_t borrow = 0;
    for (int i = 0; i <= divisor->count; i++) {
        carry += (uint64_t)q * (i < divisor->count ? divisor->limb[i] : 0);
        borrow += (int64_t)rest->limb[at + i] - (int64_t)(uint32_t)carry;
        rest->limb[at + i] = (uint32_t)borrow;
        borrow >>= 32;
        carry >>= 32;
    }
    return borrow < 0;
}

/// Adds the divisor back; returns whether the sum is still negative, which a carry out ends.
static bool add_back(natural *rest, int at, const natural *divisor) {
    uint64_t carry = 0;
    for (int i = 0; i <= divisor->count; i++) {
        carry += (uint64_t)rest->limb[at + i] + (i < divisor->count ? divisor->limb[i] : 0);
        rest->limb[at + i] = (uint32_t)carry;
        carry >>= 32;
    }
    return carry == 0;
}

/// n * 10^power for a large |power| or a long n > 0; n is used up.
static scaled scale_natural(natural *n, int power) {
    if (power >= 0) {
        multiply_power_of_5(n, power);
        int exponent = power;
        bool more = false;
        const int first = n->count > 4 ? n->count - 4 : 0;
        for (int i = 0; i < first; i++) more |= n->limb[i] != 0;
        exponent += 32 * first;
        unsigned __int128 top = 0;
        for (int i = n->count; i-- > first;) top = top << 32 | n->limb[i];
        return normalise(top, exponent, more);
    }
    // Shift both so that the divisor fills its limbs and the dividend has 64 bits more: 2^63 < quotient <
    // 2^65.
    natural divisor = {.limb = {1}, .count = 1};
    multiply_power_of_5(&divisor, -power);
    const int dividend_bits = bit_length(n), divisor_bits = bit_length(&divisor);
    const int wanted = divisor_bits > dividend_bits - 64 ? divisor_bits : dividend_bits - 64;
    const int aligned = (wanted + 31) / 32 * 32;
    shift_left(&divisor, aligned - divisor_bits);
    shift_left(n, aligned + 64 - dividend_bits);
    const int exponent = power + (aligned - divisor_bits) - (aligned + 64 - dividend_bits);
    const int count = divisor.count;
    n->limb[n->count] = 0;
    unsigned __int128 quotient = 0;
    for (int at = n->count - count; at >= 0; at--) {
        const uint64_t top = (uint64_t)n->limb[at + count] << 32 | n->limb[at + count - 1];
        const uint64_t guess = top / divisor.limb[count - 1];
        uint32_t q =
            guess > UINT32_MAX ? UINT32_MAX : (uint32_t)guess; // at most 2 too large, by Knuth's theorem B
        for (bool negative = subtract_product(n, at, &divisor, q); negative; q--)
            negative = add_back(n, at, &divisor);
        quotient = quotient << 32 | q;
    }
    bool more = false;
    for (int i = 0; i < count; i++) more |= n->limb[i] != 0;
    return normalise(quotient, exponent, more);
}

// ---- w * 10^power in binary ------------------------------------------------------------------------------

static scaled scale(uint64_t w, int power) {
    if (power >= 0 && power <= MAX_SMALL_POWER)
        return normalise((unsigned __int128)w * powers_of_5[power], power, false);
    if (power < 0 && power >= -MAX_SMALL_POWER) {
        const int zeros = __builtin_clzll(w);
        const unsigned __int128 dividend = (unsigned __int128)(w << zeros) << 64;
        const uint64_t divisor = powers_of_5[-power];
        const unsigned __int128 quotient = dividend / divisor;
        return normalise(quotient, power - 64 - zeros, quotient * divisor != dividend);
    }
    natural n = {.limb = {(uint32_t)w, (uint32_t)(w >> 32)}, .count = w >> 32 ? 2 : 1};
    return scale_natural(&n, power);
}

/// floor(s / 2^shift) rounded to nearest even, for 1 <= shift <= 64 bits that are cut off.
static uint64_t round_off(const scaled *s, int shift) {
    const uint64_t kept = shift < 64 ? s->leading >> shift : 0;
    const uint64_t half = (uint64_t)1 << (shift - 1);
    const uint64_t cut = shift < 64 ? s->leading & (half + (half - 1)) : s->leading;
    return kept + (cut > half || (cut == half && (s->more || kept & 1)));
}

/// The bits of the nearest number of a format, without sign.
static uint64_t assemble(const scaled *s, const format *f) {
    int shift = 63 - f->fraction_bits;
    if (s->exponent + shift < f->min_exponent) shift = f->min_exponent - s->exponent;
    if (shift > 64) return 0;
    // A rounding carry runs into the exponent field, where it belongs.
    const int64_t exponent = s->exponent + shift - f->min_exponent;
    if (exponent > 4096) return f->infinity_bits;
    const uint64_t bits = round_off(s, shift) + ((uint64_t)exponent << f->fraction_bits);
    return bits < f->infinity_bits ? bits : f->infinity_bits;
}

// ---- reading ---------------------------------------------------------------------------------------------

static bool is_digit(char c) { return (unsigned char)(c - '0') < 10; }

/// Appends the digits at `text` to *digits (modulo 2^64) and returns where they end: eight bytes at a time,
/// of which the leading run of digits is moved to the end so that zeros stand before it.
static inline const char *read_digits(const char *text, const char *end, uint64_t *digits) {
    while (end - text >= 8) {
        uint64_t word;
        memcpy(&word, text, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
        word = __builtin_bswap64(word);
#endif
        word ^= 0x3030303030303030u; // digits become 0 to 9, everything else more
        const uint64_t others = ((word + 0x7676767676767676u) | word) & 0x8080808080808080u;
        const int count = others ? __builtin_ctzll(others) / 8 : 8;
        if (count == 0) return text;
        word <<= 64 - 8 * count;
        word = word * 10 + (word >> 8); // pairs of digits in every other byte
        word = ((word & 0x000000ff000000ffu) * 0x000f424000000064u +
                (word >> 16 & 0x000000ff000000ffu) * 0x0000271000000001u) >>
               32;
        *digits = *digits * small_powers_of_10[count] + word;
        text += count;
        if (count < 8) return text;
    }
    for (; text < end && is_digit(*text); text++) *digits = *digits * 10 + (uint64_t)(*text - '0');
    return text;
}

/// Collects the first 19 significant digits of text that has more digits than 64 bits hold.
static void read_long_digits(decimal *d) {
    int kept = 0;
    int64_t behind_point = 0, dropped = 0;
    bool point = false;
    d->digits = 0;
    for (const char *text = d->first; text < d->last; text++) {
        if (*text == '.') {
            point = true;
            continue;
        }
        behind_point += point;
        if (kept == 0 && *text == '0') continue;
        if (kept < 19) {
            d->digits = d->digits * 10 + (uint64_t)(*text - '0');
            kept++;
        } else {
            dropped++;
            d->cut |= *text != '0';
        }
    }
    d->exponent = d->written_exponent - behind_point + dropped;
}

/// Takes decimal text apart; returns where it ends, or NULL when there is no digit.
static inline const char *read_decimal(const char *text, const char *end, decimal *d) {
    d->negative = text < end && *text == '-';
    if (text < end && (*text == '-' || *text == '+')) text++;
    d->first = text;
    d->digits = 0;
    d->cut = false;
    text = read_digits(text, end, &d->digits);
    int64_t count = text - d->first, behind_point = 0;
    if (text < end && *text == '.') {
        const char *point = text;
        text = read_digits(text + 1, end, &d->digits);
        behind_point = text - point - 1;
        count += behind_point;
    }
    if (count == 0) return NULL;
    d->last = text;
    d->written_exponent = 0;
    if (text < end && (*text == 'e' || *text == 'E')) {
        const char *sign = text + 1;
        const bool below_one = sign < end && *sign == '-';
        const char *digit = sign + (sign < end && (*sign == '-' || *sign == '+'));
        if (digit < end && is_digit(*digit)) {
            int64_t value = 0;
            for (; digit < end && is_digit(*digit); digit++)
                if (value < EXPONENT_BOUND) value = value * 10 + (*digit - '0');
            d->written_exponent = below_one ? -value : value;
            text = digit;
        }
    }
    d->exponent = d->written_exponent - behind_point;
    if (count > 19) read_long_digits(d);
    return text;
}

/// All digits that can matter, as a long integer times 10^*power.
static void collect_digits(const decimal *d, natural *n, int *power) {
    int kept = 0;
    int64_t behind_point = 0, dropped = 0;
    bool point = false, more = false;
    n->count = 0;
    for (const char *text = d->first; text < d->last; text++) {
        if (*text == '.') {
            point = true;
            continue;
        }
        behind_point += point;
        if (kept == 0 && *text == '0') continue;
        if (kept < MAX_DIGITS) {
            multiply_add(n, 10, (uint32_t)(*text - '0'));
            kept++;
        } else {
            dropped++;
            more |= *text != '0';
        }
    }
    *power =
        (int)(d->written_exponent - behind_point + dropped); // small: the caller has looked at the magnitude
    if (more) {
        multiply_add(n, 10, 1);
        *power -= 1;
    }
}

static uint64_t power_of_10(int power) { return powers_of_5[power] << power; }

/// floor(log10(2^exponent)) for |exponent| < 1200: 78913 / 2^18 is a hair below log10(2).
static int decimal_exponent(int exponent) { return (exponent * 78913) >> 18; }

static int decimal_length(uint64_t n) {
    const int minimum = decimal_exponent(63 - __builtin_clzll(n | 1)) + 1;
    return minimum + (minimum < 20 && n >= power_of_10(minimum));
}

/// The bits of the number of a format nearest to a decimal of non-zero digits, by integer arithmetic.
static uint64_t round_decimal(const decimal *d, const format *f) {
    const int64_t magnitude = d->exponent + decimal_length(d->digits);
    if (magnitude > DECIMAL_INFINITE) return f->infinity_bits;
    if (magnitude < DECIMAL_ZERO) return 0;
    scaled s;
    if (d->cut) {
        natural n;
        int power;
        collect_digits(d, &n, &power);
        s = scale_natural(&n, power);
    } else {
        s = scale(d->digits, (int)d->exponent);
    }
    return assemble(&s, f);
}

static double bits_to_f64(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float bits_to_f32(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t f64_to_bits(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static uint32_t f32_to_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// Magnitude as double by Clinger's path; false when it is not exact there.
static inline bool is_direct(const decimal *d, double *value) {
    if (d->cut || d->digits > (uint64_t)1 << 53 || d->exponent < -MAX_EXACT_POWER ||
        d->exponent > MAX_EXACT_POWER)
        return false;
    const double digits = (double)d->digits;
    *value = d->exponent < 0 ? digits / powers_of_10[-d->exponent] : digits * powers_of_10[d->exponent];
    return true;
}

/// Compares with a lower-case word; returns what follows it or NULL.
static const char *skip_word(const char *text, const char *end, const char *word) {
    for (; *word; word++, text++)
        if (text == end || (*text | ('A' <= *text && *text <= 'Z' ? 0x20 : 0)) != *word) return NULL;
    return text;
}

/// Reads the words for what is no finite number.
static const char *read_word(const char *text, const char *end, double *value) {
    static const struct {
        const char *word;
        bool infinite;
    } words[] = {
        // Longer ones before those they begin with.
        {"nan(ind)", false}, {"nan(snan)", false}, {"nan", false},    {"infinity", true}, {"inf", true},
        {"1.#qnan", false},  {"1.#snan", false},   {"1.#ind", false}, {"1.#inf", true},
    };
    const bool negative = text < end && *text == '-';
    if (text < end && (*text == '-' || *text == '+')) text++;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        const char *after = skip_word(text, end, words[i].word);
        if (!after) continue;
        // Windows pads the digits that were asked for: 1.#QNAN0, 1.#INF00.
        while (words[i].word[0] == '1' && after < end && *after == '0') after++;
        *value = copysign(words[i].infinite ? INFINITY : NAN, negative ? -1.0 : 1.0);
        return after;
    }
    return NULL;
}

static double nearest_f64(const decimal *d) {
    double value;
    if (is_direct(d, &value)) return value;
    return d->digits ? bits_to_f64(round_decimal(d, &binary64)) : 0;
}

static float nearest_f32(const decimal *d) {
    // Rounding to double and then to float errs only where the double lies midway between two floats: its
    // last 29 bits are then 1000... . The first path gives no double so small that floats near it have fewer
    // bits.
    double wide;
    if (is_direct(d, &wide) && (f64_to_bits(wide) & 0x1fffffff) != 0x10000000) return (float)wide;
    return d->digits ? bits_to_f32((uint32_t)round_decimal(d, &binary32)) : 0;
}

const char *ewa_number_read_f64(const char *text, const char *end, double *value) {
    decimal d;
    const char *after = read_decimal(text, end, &d);
    if (!after || (after < end && *after == '#')) return read_word(text, end, value);
    const double magnitude = nearest_f64(&d);
    *value = d.negative ? -magnitude : magnitude;
    return after;
}

const char *ewa_number_read_shifted(const char *text, const char *end, int64_t shift, double *value) {
    decimal d;
    const char *after = read_decimal(text, end, &d);
    if (!after || (after < end && *after == '#')) return read_word(text, end, value);
    if (shift != 0 && !d.cut && d.exponent <= 0 && d.exponent >= -18) {
        const __int128 digits = d.negative ? -(__int128)d.digits : (__int128)d.digits;
        const __int128 rest = digits - (__int128)shift * (__int128)power_of_10((int)-d.exponent);
        const unsigned __int128 magnitude = (unsigned __int128)(rest < 0 ? -rest : rest);
        if (magnitude >> 64 == 0) {
            d.digits = (uint64_t)magnitude;
            d.negative = rest < 0;
            shift = 0;
        }
    }
    const double magnitude = nearest_f64(&d);
    *value = (d.negative ? -magnitude : magnitude) - (double)shift;
    return after;
}

const char *ewa_number_read_f32(const char *text, const char *end, float *value) {
    decimal d;
    const char *after = read_decimal(text, end, &d);
    if (!after || (after < end && *after == '#')) {
        double word;
        after = read_word(text, end, &word);
        if (after) *value = (float)word;
        return after;
    }
    const float magnitude = nearest_f32(&d);
    *value = d.negative ? -magnitude : magnitude;
    return after;
}

const char *ewa_number_read_i64(const char *text, const char *end, int64_t *value) {
    const bool negative = text < end && *text == '-';
    if (text < end && (*text == '-' || *text == '+')) text++;
    uint64_t digits = 0;
    const char *after = read_digits(text, end, &digits);
    if (after == text || after - text > 18) return NULL;
    *value = negative ? -(int64_t)digits : (int64_t)digits;
    return after;
}

// ---- writing ---------------------------------------------------------------------------------------------

/// Rounds significand * 2^exponent to `count` significant decimal digits: returned digits * 10^*power.
static uint64_t to_decimal(uint64_t significand, int exponent, int count, int *power) {
    // From the leading bit alone, the decimal exponent is right or one too small.
    int magnitude = decimal_exponent(exponent + 63 - __builtin_clzll(significand));
    for (;; magnitude++) {
        *power = magnitude - (count - 1);
        scaled s = scale(significand, -*power);
        s.exponent += exponent;
        const uint64_t digits = round_off(&s, -s.exponent); // at most 18 digits: 4 bits and more are cut off
        if (digits < power_of_10(count)) return digits;
    }
}

static size_t write_unsigned(uint64_t value, char *text) {
    const int length = decimal_length(value);
    for (int i = length; i-- > 0; value /= 10) text[i] = (char)('0' + value % 10);
    return (size_t)length;
}

/// Lays out digits * 10^power: plainly while that needs few zeros, else with an exponent.
static size_t write_decimal(uint64_t digits, int power, char *text) {
    while (digits % 10 == 0) {
        digits /= 10;
        power++;
    }
    char plain[EWA_NUMBER_BYTES];
    const int length = (int)write_unsigned(digits, plain);
    const int magnitude = power + length - 1; // of the leading digit
    size_t at = 0;
    if (magnitude < -5 || magnitude > 16) {
        text[at++] = plain[0];
        if (length > 1) text[at++] = '.';
        memcpy(text + at, plain + 1, (size_t)length - 1);
        at += (size_t)length - 1;
        text[at++] = 'e';
        if (magnitude < 0) text[at++] = '-';
        return at + write_unsigned((uint64_t)(magnitude < 0 ? -magnitude : magnitude), text + at);
    }
    for (int place = magnitude > 0 ? magnitude : 0; place >= power || place >= 0; place--) {
        if (place == -1) text[at++] = '.';
        const int index = magnitude - place;
        text[at++] = index >= 0 && index < length ? plain[index] : '0';
    }
    return at;
}

static bool reads_as(const decimal *d, uint64_t bits, const format *f) {
    if (f == &binary64) return f64_to_bits(nearest_f64(d)) == bits;
    return f32_to_bits(nearest_f32(d)) == bits;
}

/// Writes a finite number given by its bits: the fewest digits from `minimum` to `maximum` that round back to
/// it.
static size_t write_finite(uint64_t bits, const format *f, int minimum, int maximum, char *text) {
    const uint64_t field = bits >> f->fraction_bits;
    const uint64_t fraction = bits & (((uint64_t)1 << f->fraction_bits) - 1);
    const uint64_t significand = field ? fraction | (uint64_t)1 << f->fraction_bits : fraction;
    const int exponent = f->min_exponent + (field ? (int)field - 1 : 0);
    if (significand == 0) {
        text[0] = '0';
        return 1;
    }
    int power;
    const uint64_t digits = to_decimal(significand, exponent, maximum, &power);
    for (int count = minimum; count < maximum; count++) {
        const uint64_t cut = power_of_10(maximum - count);
        const decimal shorter = {.digits = (digits + cut / 2) / cut, .exponent = power + maximum - count};
        if (reads_as(&shorter, bits, f)) return write_decimal(shorter.digits, (int)shorter.exponent, text);
    }
    return write_decimal(digits, power, text);
}

static size_t write_float(double value, uint64_t bits, const format *f, int minimum, int maximum,
                          char *text) {
    if (isnan(value)) {
        memcpy(text, "nan", 3);
        return 3;
    }
    size_t at = 0;
    if (signbit(value)) text[at++] = '-';
    if (isinf(value)) {
        memcpy(text + at, "inf", 3);
        return at + 3;
    }
    return at + write_finite(bits, f, minimum, maximum, text + at);
}

size_t ewa_number_write_f64(double value, char text[EWA_NUMBER_BYTES]) {
    return write_float(value, f64_to_bits(value) & INT64_MAX, &binary64, 15, 17, text);
}

size_t ewa_number_write_f32(float value, char text[EWA_NUMBER_BYTES]) {
    return write_float(value, f32_to_bits(value) & INT32_MAX, &binary32, 6, 9, text);
}

size_t ewa_number_write_i64(int64_t value, char text[EWA_NUMBER_BYTES]) {
    text[0] = '-';
    return value < 0 ? 1 + write_unsigned(0 - (uint64_t)value, text + 1)
                     : write_unsigned((uint64_t)value, text);
}
