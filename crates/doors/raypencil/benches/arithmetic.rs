//! "The computation can be speeded up in the future by converting the code from floating point to integer arithmetic."
//! (Paper, section 8) The three inner computations of both renderers in f64, and in fixed point with 64 and 128 bits;
//! `docs/evidence/results.md` has the bits that each needs.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

/// Number of operands; they fit the caches.
const COUNT: usize = 4096;

/// A number type: f64, or fixed point with a given number of fractional bits.
trait Number: Copy + Send + Sync + 'static {
    fn new(place: f64, bits: u32) -> Self;
    fn times(self, other: Self) -> Self;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn over(self, other: Self) -> Self;
    fn largest(self, other: Self) -> Self;
}

macro_rules! integer {
    ($type:ty) => {
        impl Number for $type {
            fn new(place: f64, bits: u32) -> Self {
                (place * (1_u64 << bits) as f64) as Self
            }
            // Wrapping, as integers behave in a release build.
            fn times(self, other: Self) -> Self {
                self.wrapping_mul(other)
            }
            fn plus(self, other: Self) -> Self {
                self.wrapping_add(other)
            }
            fn minus(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }
            fn over(self, other: Self) -> Self {
                self.wrapping_div(other | 1)
            }
            fn largest(self, other: Self) -> Self {
                self.max(other)
            }
        }
    };
}

integer!(i64);

integer!(i128);

impl Number for f64 {
    fn new(place: f64, _bits: u32) -> Self {
        place
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn minus(self, other: Self) -> Self {
        self - other
    }
    fn over(self, other: Self) -> Self {
        self / other
    }
    fn largest(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
}

/// Two positions within 32 m, then a direction within 1, repeated; the same numbers for every type.
fn operands<N: Number>(place_bits: u32, direction_bits: u32) -> Vec<[N; 3]> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..COUNT)
        .map(|index| {
            let direction = index % 3 == 2;
            let (scale, bits) = if direction { (1.0, direction_bits) } else { (32.0, place_bits) };
            [0; 3].map(|_| N::new(next() * scale, bits))
        })
        .collect()
}

/// The side on which a ray passes an edge: the determinant of two vertices relative to the sensor and the direction.
fn side<N: Number>(bencher: Bencher, place_bits: u32, direction_bits: u32) {
    let vectors = operands::<N>(place_bits, direction_bits);
    let determinant = |[a, b, q]: [[N; 3]; 3]| {
        let x = a[1].times(b[2]).minus(a[2].times(b[1]));
        let y = a[2].times(b[0]).minus(a[0].times(b[2]));
        let z = a[0].times(b[1]).minus(a[1].times(b[0]));
        x.times(q[0]).plus(y.times(q[1])).plus(z.times(q[2]))
    };
    bencher.counter(ItemsCount::new(COUNT / 3)).bench_local(|| {
        for three in black_box(&vectors).chunks_exact(3) {
            black_box(determinant([three[0], three[1], three[2]]));
        }
    });
}

#[divan::bench]
fn side_of_edge_f64(bencher: Bencher) {
    side::<f64>(bencher, 0, 0);
}

#[divan::bench]
fn side_of_edge_i64_15_and_20_bits(bencher: Bencher) {
    side::<i64>(bencher, 15, 20);
}

#[divan::bench]
fn side_of_edge_i128_38_and_40_bits(bencher: Bencher) {
    side::<i128>(bencher, 38, 40);
}

/// 1/t along a row as in `scanline`: computed anew at each pixel, so that errors do not accumulate; the nearest stays.
#[divan::bench]
fn row_of_pixels_f64_afresh(bencher: Bencher) {
    let nearest: Vec<f64> = operands::<f64>(0, 0).iter().map(|vector| vector[0]).collect();
    let slope = black_box(1.0 / 1024.0);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let mut nearest = black_box(&nearest).clone();
        for (x, pixel) in nearest.iter_mut().enumerate() {
            *pixel = pixel.largest(slope * (x as f64 + 0.5) + 0.25);
        }
        black_box(nearest)
    });
}

/// The same, stepped by one addition per pixel.
fn row<N: Number>(bencher: Bencher, bits: u32) {
    let nearest: Vec<N> = operands::<N>(bits, bits).iter().map(|vector| vector[0]).collect();
    let step = N::new(1.0 / 1024.0, bits);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let mut nearest = black_box(&nearest).clone();
        let mut here = N::new(0.25, bits);
        for pixel in &mut nearest {
            *pixel = pixel.largest(here);
            here = here.plus(step);
        }
        black_box(nearest)
    });
}

#[divan::bench]
fn row_of_pixels_f64_stepped(bencher: Bencher) {
    row::<f64>(bencher, 0);
}

#[divan::bench]
fn row_of_pixels_i64_stepped(bencher: Bencher) {
    row::<i64>(bencher, 40);
}

/// t = d / (n.q): a dot product and a division.
fn distance<N: Number>(bencher: Bencher, place_bits: u32, direction_bits: u32) {
    let vectors = operands::<N>(place_bits, direction_bits);
    bencher.counter(ItemsCount::new(COUNT / 3)).bench_local(|| {
        for three in black_box(&vectors).chunks_exact(3) {
            let (n, q) = (three[0], three[2]);
            let along = n[0].times(q[0]).plus(n[1].times(q[1])).plus(n[2].times(q[2]));
            let d = three[1][0].times(three[1][1]);
            black_box(d.over(along));
        }
    });
}

#[divan::bench]
fn distance_f64(bencher: Bencher) {
    distance::<f64>(bencher, 0, 0);
}

#[divan::bench]
fn distance_i64_15_and_20_bits(bencher: Bencher) {
    distance::<i64>(bencher, 15, 20);
}

#[divan::bench]
fn distance_i128_38_and_40_bits(bencher: Bencher) {
    distance::<i128>(bencher, 38, 40);
}
