//! A runner of proptest that draws scenes, whatever the environment says.

use proptest::test_runner::{Config, RngAlgorithm, RngSeed, TestRng, TestRunner, noop_result_cache};

/// A runner that draws by `rng`.
///
/// The variables PROPTEST_... of a developer's tests may not change a campaign, nor print a line of their own about a value
/// that is none. `Config::default()` reads them, so each field is written here, with proptest's own value. For the fields
/// to be the same in every program, `Cargo.toml` names the features that add some, and the minor version.
pub(crate) fn drawing(rng: TestRng) -> TestRunner {
    let config = Config {
        cases: 256,
        max_local_rejects: 65_536,
        max_global_rejects: 1024,
        max_flat_map_regens: 1_000_000,
        failure_persistence: None,
        source_file: None,
        test_name: None,
        fork: false,
        timeout: 0,
        max_shrink_time: 0,
        max_shrink_iters: u32::MAX,
        max_default_size_range: 100,
        result_cache: noop_result_cache,
        verbose: 0,
        rng_algorithm: RngAlgorithm::ChaCha,
        rng_seed: RngSeed::Fixed(0),
        _non_exhaustive: (),
    };
    TestRunner::new_with_rng(config, rng)
}
