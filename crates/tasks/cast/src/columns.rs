//! The values of first hits as columns: an array for each value that is asked for, and no other is formed.

use rayon::join;
use raypencil_referee::{CastMeeting, ExactCast};
use raypencil_scene::{CastRay, Reading, Side, Sides};
use raypencil_tracer::{TracedMeeting, TracerCast};

use crate::answers::{DecidedCounts, TRACED_RAYS_A_PART, side_number};

/// Rays that one thread answers by itself.
const RAYS_A_PART: usize = 256;

/// What stands for no face.
const NO_FACE: u32 = u32::MAX;

/// Who answers.
#[derive(Debug, Clone, Copy)]
pub enum Caster<'t> {
    /// The referee: exactly, every number correctly rounded.
    Referee(&'t ExactCast<'t>),
    /// The tracer: in `f64`, without ties.
    Tracer(&'t TracerCast),
}

/// How many rays read what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ReadingCounts {
    /// Rays that hit something.
    pub hits: u64,
    /// Rays whose nearest hit is too near for their sensor.
    pub too_near: u64,
    /// Hits of the back of a face.
    pub backs: u64,
    /// What decided this; nothing if the tracer answered.
    pub decided: DecidedCounts,
}

impl ReadingCounts {
    /// The counts of both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            hits: self.hits + other.hits,
            too_near: self.too_near + other.too_near,
            backs: self.backs + other.backs,
            decided: self.decided.and(other.decided),
        }
    }
}

/// A first hit whose values are formed when they are asked for.
trait Hit {
    fn face(&self) -> u32;
    fn met_side(&self) -> Side;
    fn side(&self) -> i8 {
        side_number(self.met_side())
    }
    fn ties(&self) -> u32;
    fn t(&self) -> f64;
    fn range(&self) -> f64;
    fn cos_incidence(&self) -> f64;
    fn point(&self) -> [f64; 3];
    fn normal(&self) -> [f64; 3];
    fn barycentric(&self) -> [f64; 3];
}

impl Hit for (CastMeeting<'_>, u32) {
    fn face(&self) -> u32 {
        self.0.face().0
    }
    fn met_side(&self) -> Side {
        self.0.side()
    }
    fn ties(&self) -> u32 {
        self.1
    }
    fn t(&self) -> f64 {
        self.0.t().double
    }
    fn range(&self) -> f64 {
        self.0.range().double
    }
    fn cos_incidence(&self) -> f64 {
        self.0.cos_incidence().double
    }
    fn point(&self) -> [f64; 3] {
        self.0.point().map(|part| part.double)
    }
    fn normal(&self) -> [f64; 3] {
        self.0.normal().map(|part| part.double)
    }
    fn barycentric(&self) -> [f64; 3] {
        self.0.barycentric().map(|weight| weight.double)
    }
}

impl Hit for TracedMeeting<'_, '_> {
    fn face(&self) -> u32 {
        self.face().0
    }
    fn met_side(&self) -> Side {
        self.side()
    }
    fn ties(&self) -> u32 {
        1
    }
    fn t(&self) -> f64 {
        self.t()
    }
    fn range(&self) -> f64 {
        self.hit().range
    }
    fn cos_incidence(&self) -> f64 {
        self.hit().cos_incidence
    }
    fn point(&self) -> [f64; 3] {
        self.hit().point.to_array()
    }
    fn normal(&self) -> [f64; 3] {
        self.hit().normal.to_array()
    }
    fn barycentric(&self) -> [f64; 3] {
        self.hit().barycentric
    }
}

macro_rules! columns {
    ($($(#[$doc:meta])* $name:ident: $number:ty = ($miss:expr, $too_near:expr);)*) => {
        /// Which values of first hits are asked for.
        #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
        pub struct Values {
            $($(#[$doc])* pub $name: bool,)*
        }

        impl Values {
            /// All of them.
            pub const ALL: Self = Self { $($name: true,)* };

            /// The names of all, in order.
            pub const NAMES: &[&str] = &[$(stringify!($name)),*];

            /// Those whose bits are set; the first of the names is the lowest bit.
            pub fn of_bits(bits: u32) -> Self {
                let mut next = 0..;
                Self { $($name: next.next().is_some_and(|bit| bits >> bit & 1 == 1),)* }
            }

            /// Those with these names; the first name that is none is the error.
            ///
            /// ```
            /// use raypencil_cast::Values;
            ///
            /// let asked = Values::named(["t", "face"]).unwrap();
            /// assert!(asked.t && asked.face && !asked.point);
            /// assert_eq!(Values::named(["t", "depth"]), Err("depth".into()));
            /// ```
            pub fn named<'n>(names: impl IntoIterator<Item = &'n str>) -> Result<Self, String> {
                let mut values = Self::default();
                for name in names {
                    match name {
                        $(stringify!($name) => values.$name = true,)*
                        _ => return Err(name.into()),
                    }
                }
                Ok(values)
            }
        }

        /// Values of the first hits of some rays, in their order; `None` is not asked for.
        #[derive(Debug, Clone, Default, PartialEq)]
        pub struct FirstColumns {
            $($(#[$doc])* pub $name: Option<Vec<$number>>,)*
        }

        impl FirstColumns {
            /// Columns for so many rays, all of which miss until they are [asked](Self::part).
            pub fn new(rays: usize, values: Values) -> Self {
                Self { $($name: values.$name.then(|| vec![$miss; rays]),)* }
            }

            /// The part for some of the rays.
            ///
            /// # Panics
            /// If there are not so many rays.
            pub fn part(&mut self, rays: std::ops::Range<usize>) -> ColumnsPart<'_> {
                ColumnsPart {
                    rays: rays.len(),
                    $($name: self.$name.as_mut().map(|column| &mut column[rays.clone()]),)*
                }
            }
        }

        /// A part of [`FirstColumns`].
        #[derive(Debug)]
        pub struct ColumnsPart<'c> {
            rays: usize,
            $($name: Option<&'c mut [$number]>,)*
        }

        impl<'c> ColumnsPart<'c> {
            fn split_at(self, middle: usize) -> (Self, Self) {
                $(let $name = self.$name.map(|column| column.split_at_mut(middle)).unzip();)*
                (
                    Self { rays: middle, $($name: $name.0,)* },
                    Self { rays: self.rays - middle, $($name: $name.1,)* },
                )
            }

            fn set(&mut self, ray: usize, read: &Reading<impl Hit>) {
                $(if let Some(column) = &mut self.$name {
                    column[ray] = match read {
                        Reading::Hit(hit) => hit.$name(),
                        Reading::TooNear => $too_near,
                        Reading::Miss => $miss,
                    };
                })*
            }
        }
    };
}

columns! {
    /// The first face; of several at the same t the lowest; 4294967295 without a hit.
    face: u32 = (NO_FACE, NO_FACE);
    /// 1 front, -1 back, 0 without a hit.
    side: i8 = (0, 0);
    /// Number of faces at exactly this t, 0 without a hit. The tracer knows of none, and says 1.
    ties: u32 = (0, 0);
    /// The ray's parameter; +Inf without a hit, -Inf for what is too near.
    t: f64 = (f64::INFINITY, f64::NEG_INFINITY);
    /// Distance from the ray's origin, in the mesh's unit; +Inf without a hit, -Inf for what is too near.
    range: f64 = (f64::INFINITY, f64::NEG_INFINITY);
    /// Cosine of the angle between the normal and the reversed ray; NaN without a hit.
    cos_incidence: f64 = (f64::NAN, f64::NAN);
    /// The point; NaN without a hit.
    point: [f64; 3] = ([f64::NAN; 3], [f64::NAN; 3]);
    /// The unit normal to the face's front; NaN without a hit.
    normal: [f64; 3] = ([f64::NAN; 3], [f64::NAN; 3]);
    /// The weights of the face's corners; NaN without a hit.
    barycentric: [f64; 3] = ([f64::NAN; 3], [f64::NAN; 3]);
}

impl ColumnsPart<'_> {
    /// Answers the rays of this part: on all threads of the pool, or if they are a few on this one. The same numbers as
    /// [`cast`](crate::cast), and as [`Answers::traced`](crate::Answers::traced).
    ///
    /// # Panics
    /// If the rays are not as many as the part has.
    ///
    /// ```
    /// use raypencil_cast::{Caster, FirstColumns, Values, rays_from_bytes};
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{Sides, Triangles};
    ///
    /// let mesh = Triangles::new(vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], vec![[0, 1, 2]])?;
    /// let rays = rays_from_bytes(b"1,1,3, 0,0,-2\n5,5,3, 0,0,-2\n", "rays.csv".as_ref())?.rays;
    /// let mut columns = FirstColumns::new(2, Values::named(["t", "face"])?);
    /// let exact = ExactCast::new(&mesh);
    /// let counts = columns.part(0..2).ask(Caster::Referee(&exact), &rays, Sides::Both);
    /// assert_eq!((columns.t, columns.face), (Some(vec![1.5, f64::INFINITY]), Some(vec![0, u32::MAX])));
    /// assert!(columns.point.is_none() && counts.hits == 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ask(mut self, caster: Caster<'_>, rays: &[CastRay], sides: Sides) -> ReadingCounts {
        assert_eq!(self.rays, rays.len(), "rays of a part of columns");
        let most = match caster {
            Caster::Referee(_) => RAYS_A_PART,
            Caster::Tracer(_) => TRACED_RAYS_A_PART,
        };
        if rays.len() > most {
            let middle = rays.len() / 2;
            let (lower, upper) = self.split_at(middle);
            let (a, b) = join(
                || lower.ask(caster, &rays[..middle], sides),
                || upper.ask(caster, &rays[middle..], sides),
            );
            return a.and(b);
        }
        let mut counts = ReadingCounts::default();
        match caster {
            Caster::Referee(exact) => {
                exact.first_meetings(rays, sides, |index, read, decided_by| {
                    self.put(index, read, &mut counts);
                    counts.decided.add(decided_by);
                });
            }
            Caster::Tracer(tracer) => {
                tracer.traverser().first_of_each(rays, sides, |index, met| {
                    let read = Reading::of(met, |met| rays[index].is_too_near(met.t()));
                    self.put(index, &read, &mut counts);
                });
            }
        }
        counts
    }

    /// Puts down what the ray of this index reads.
    fn put(&mut self, index: usize, read: &Reading<impl Hit>, counts: &mut ReadingCounts) {
        match read {
            Reading::Hit(hit) => {
                counts.hits += 1;
                counts.backs += u64::from(hit.met_side() == Side::Back);
            }
            Reading::TooNear => counts.too_near += 1,
            Reading::Miss => {}
        }
        self.set(index, read);
    }
}
