//! Arrays that are made without Python, and handed to it without a copy. Python may not write into them.

use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{Element, PyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Failure;

/// The numbers of an array.
#[derive(Debug)]
pub(crate) enum Numbers {
    F64(Vec<f64>),
    F32(Vec<f32>),
    U64(Vec<u64>),
    U32(Vec<u32>),
    U16(Vec<u16>),
    U8(Vec<u8>),
    I32(Vec<i32>),
    I8(Vec<i8>),
    Bool(Vec<bool>),
}

/// An array of any shape, in C order.
#[derive(Debug)]
pub(crate) struct Array {
    shape: Vec<usize>,
    numbers: Numbers,
}

macro_rules! numbers {
    ($($variant:ident($number:ty)),*) => {
        $(impl From<Vec<$number>> for Numbers {
            fn from(numbers: Vec<$number>) -> Self {
                Self::$variant(numbers)
            }
        })*

        impl Numbers {
            fn len(&self) -> usize {
                match self { $(Self::$variant(numbers) => numbers.len()),* }
            }
        }

        impl Array {
            /// The array of NumPy, which owns the numbers.
            pub(crate) fn into_numpy(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
                match self.numbers { $(Numbers::$variant(numbers) => owned(py, self.shape, numbers)),* }
            }
        }
    };
}

numbers!(F64(f64), F32(f32), U64(u64), U32(u32), U16(u16), U8(u8), I32(i32), I8(i8), Bool(bool));

fn owned<T: Element>(py: Python<'_>, shape: Vec<usize>, numbers: Vec<T>) -> PyResult<Bound<'_, PyAny>> {
    let array = ArrayD::from_shape_vec(IxDyn(&shape), numbers)
        .map_err(|error| Failure::from(error).into_exception(py))?;
    Ok(PyArray::from_owned_array(py, array).readwrite().make_nonwriteable().as_any().clone())
}

impl Array {
    /// An array of this shape.
    ///
    /// # Panics
    /// If the shape has another number of cells.
    pub(crate) fn new(shape: &[usize], numbers: impl Into<Numbers>) -> Self {
        let numbers = numbers.into();
        assert_eq!(shape.iter().product::<usize>(), numbers.len(), "cells of an array of shape {shape:?}");
        Self { shape: shape.to_vec(), numbers }
    }
}

/// Arrays by name, in order.
#[derive(Debug, Default)]
pub(crate) struct Arrays(Vec<(String, Array)>);

impl Arrays {
    /// Adds one.
    pub(crate) fn add(&mut self, name: impl Into<String>, shape: &[usize], numbers: impl Into<Numbers>) {
        self.0.push((name.into(), Array::new(shape, numbers)));
    }

    /// Adds one, if there is one.
    pub(crate) fn add_some(
        &mut self,
        name: &'static str,
        shape: &[usize],
        numbers: Option<impl Into<Numbers>>,
    ) {
        if let Some(numbers) = numbers {
            self.add(name, shape, numbers);
        }
    }

    /// A dictionary of arrays of NumPy.
    pub(crate) fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        for (name, array) in self.0 {
            dict.set_item(name, array.into_numpy(py)?)?;
        }
        Ok(dict)
    }
}
