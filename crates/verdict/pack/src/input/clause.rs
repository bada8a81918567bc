//! The clauses of loading: what a loader must do with a glTF file.

/// Defines the clauses in one list: each with its key and its sentence.
macro_rules! clauses {
    ($($name:ident: $key:literal, $sentence:literal;)*) => {
        /// A clause of loading (`docs/theory/contract.md`, `docs/formats/files.md`).
        ///
        /// ```
        /// use raypencil_pack::LoadingClause;
        ///
        /// assert_eq!(LoadingClause::Mirroring.key(), "mirroring");
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum LoadingClause {
            $(#[doc = $sentence] $name,)*
        }

        impl LoadingClause {
            /// All clauses, in the order of the document.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// Name in `input.json`: words joined by `-`.
            pub fn key(self) -> &'static str {
                match self {
                    $(Self::$name => $key,)*
                }
            }

            /// The clause in one sentence.
            pub fn sentence(self) -> &'static str {
                match self {
                    $(Self::$name => $sentence,)*
                }
            }
        }
    };
}

clauses! {
    Axes: "axes", "glTF is y up: (x, y, z) of the file is (x, -z, y) of the scene.";
    Translation: "translation", "A node moves its mesh by its translation.";
    Rotation: "rotation", "A node turns its mesh by its quaternion (x, y, z, w).";
    Scale: "scale", "A node scales its mesh along each axis.";
    PartsOfATransform: "parts-of-a-transform", "A node scales first, then turns, then moves.";
    Parents: "parents", "The transform of a parent applies after that of its child.";
    Matrix: "matrix", "A matrix is stored column by column.";
    Mirroring: "mirroring", "A transform that mirrors keeps the outside outside: the triangle's corners change their order.";
    MirroredTwice: "mirrored-twice", "A mirror in a mirror is none.";
    Instances: "instances", "A mesh is drawn for each node that has it.";
    Scene: "scene", "The nodes of the default scene are drawn, and no others.";
    OrderOfNodes: "order-of-nodes", "Faces are numbered along the tree: roots in their order, a node before its children.";
    Strip: "strip", "Every second triangle of a strip is turned round.";
    Fan: "fan", "All triangles of a fan share its first vertex.";
    WithoutIndices: "without-indices", "Without indices the vertices are taken in their order, as many as the accessor counts.";
    ByteIndices: "byte-indices", "Indices may be unsigned bytes.";
    IntIndices: "int-indices", "Indices may be unsigned ints.";
    Interleaved: "interleaved", "Vertices may be interleaved with other data: byteStride and byteOffset.";
    Primitives: "primitives", "All primitives of a mesh are drawn, in their order; points and lines are not.";
    FacesWithoutArea: "faces-without-area", "A face without area is kept: it counts.";
    Decimals: "decimals", "The numbers of a transform are doubles, and transforms are composed in double precision.";
    Reflectivity: "reflectivity", "The reflectivity of a face is that of its material, or 0.25 without one.";
}
