//! Vectors, matrices and poses, as `docs/formats/recording.md` defines them.

pub(crate) type Vector = [f64; 3];

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

pub(crate) fn times(a: Vector, factor: f64) -> Vector {
    a.map(|part| part * factor)
}

pub(crate) fn length(a: Vector) -> f64 {
    a.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Matrix, row by row.
pub(crate) type Matrix = [Vector; 3];

pub(crate) fn apply(matrix: &Matrix, vector: Vector) -> Vector {
    matrix.map(|row| row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2])
}

pub(crate) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|column| (0..3).map(|k| row[k] * b[k][column]).sum()))
}

fn transposed(matrix: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// Turn to the left, about z.
pub(crate) fn turn_left(angle: f64) -> Matrix {
    let (sin, cos) = sin_cos(angle);
    [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]
}

/// Nose down, about y.
pub(crate) fn pitch_down(angle: f64) -> Matrix {
    let (sin, cos) = sin_cos(angle);
    [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]]
}

/// Right side down, about x.
pub(crate) fn roll_right(angle: f64) -> Matrix {
    let (sin, cos) = sin_cos(angle);
    [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]]
}

/// Heading or yaw, then pitch, then roll.
pub(crate) fn attitude(angles: [f64; 3]) -> Matrix {
    product(&product(&turn_left(angles[0]), &pitch_down(angles[1])), &roll_right(angles[2]))
}

/// Matrix of a unit quaternion x, y, z, w.
pub(crate) fn of_quaternion([x, y, z, w]: [f64; 4]) -> Matrix {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Largest difference between the parts of two matrices.
pub(crate) fn apart(a: &Matrix, b: &Matrix) -> f64 {
    let parts = a.iter().flatten().zip(b.iter().flatten());
    parts.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Pose `A_from_B`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose {
    pub position: Vector,
    pub rotation: Matrix,
}

impl Pose {
    /// Position, and quaternion x, y, z, w.
    pub(crate) fn of(numbers: &[f64]) -> Self {
        let [x, y, z, qx, qy, qz, qw] = numbers.try_into().expect("seven numbers");
        let quaternion: [f64; 4] = [qx, qy, qz, qw];
        let square: f64 = quaternion.iter().map(|part| part * part).sum();
        assert!((square - 1.0).abs() < 1e-12, "a unit quaternion: {quaternion:?}");
        Self { position: [x, y, z], rotation: of_quaternion(quaternion) }
    }

    pub(crate) fn point(&self, point: Vector) -> Vector {
        add(self.position, apply(&self.rotation, point))
    }

    pub(crate) fn direction(&self, direction: Vector) -> Vector {
        apply(&self.rotation, direction)
    }

    /// `A_from_C` of `A_from_B` and `B_from_C`.
    pub(crate) fn then(&self, other: &Self) -> Self {
        Self { position: self.point(other.position), rotation: product(&self.rotation, &other.rotation) }
    }

    pub(crate) fn inverse(&self) -> Self {
        let rotation = transposed(&self.rotation);
        Self { position: times(apply(&rotation, self.position), -1.0), rotation }
    }

    /// Largest difference, metres in the position and as numbers in the matrix.
    pub(crate) fn apart(&self, other: &Self) -> f64 {
        length(minus(self.position, other.position)).max(apart(&self.rotation, &other.rotation))
    }
}
