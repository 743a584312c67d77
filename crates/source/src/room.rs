//! Memory for large arrays of samples.

/// Samples from which large pages are requested; 4 MB.
const MANY: usize = 1 << 19;

/// Zeros, on large pages where the system supports them: faulting in small ones is slow.
pub fn zeros(count: usize) -> Vec<f64> {
    let zeros = vec![0.0; count];
    if count >= MANY {
        ask_for_large_pages(&zeros);
    }
    zeros
}

#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
fn ask_for_large_pages(values: &[f64]) {
    const PAGE: usize = 4096;
    let range = values.as_ptr_range();
    let start = (range.start as usize).next_multiple_of(PAGE);
    let length = (range.end as usize).saturating_sub(start);
    // SAFETY: the range lies within the live slice, and the advice changes how its
    // pages are backed, never their contents. A refusal is harmless.
    unsafe {
        libc::madvise(start as *mut libc::c_void, length, libc::MADV_HUGEPAGE);
    }
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages(_: &[f64]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_and_few_zeros_are_zeros_to_write_to() {
        for count in [0, 1, MANY - 1, MANY, 3 * MANY + 5] {
            let mut values = zeros(count);
            assert_eq!(values.len(), count);
            assert!(values.iter().all(|value| *value == 0.0));
            values.fill(1.5);
            assert_eq!(values.iter().sum::<f64>(), 1.5 * count as f64);
        }
    }
}
