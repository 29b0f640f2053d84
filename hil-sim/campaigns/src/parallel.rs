//! A parallel map on several threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Maps the items on a number of threads; the results are in the order of the items. `done` is called after each item.
///
/// # Errors
/// The first error, in the order of the items; after an error no new item is started.
pub fn parallel_map<T: Sync, R: Send>(
    items: &[T],
    threads: usize,
    work: impl Fn(&T) -> anyhow::Result<R> + Sync,
    done: impl Fn() + Sync,
) -> anyhow::Result<Vec<R>> {
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<(usize, anyhow::Result<R>)>> =
        Mutex::new(Vec::with_capacity(items.len()));
    let thread = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return };
            let result = work(item);
            if result.is_err() {
                next.store(items.len(), Ordering::Relaxed);
            }
            // A poisoned lock is ignored: the panic of the other thread ends the map.
            if let Ok(mut results) = results.lock() {
                results.push((index, result));
            }
            done();
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            scope.spawn(thread);
        }
    });
    let mut results = results.into_inner().unwrap_or_default();
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..100).collect();
        let slow_first = |item: &u64| {
            std::thread::sleep(std::time::Duration::from_micros(100 - item));
            Ok(item * item)
        };
        let squares = parallel_map(&items, 4, slow_first, || ()).expect("no error");
        assert_eq!(squares, items.iter().map(|item| item * item).collect::<Vec<_>>());
    }

    #[test]
    fn an_error_ends_the_work() {
        let items: Vec<u32> = (0..1000).collect();
        let begun = AtomicUsize::new(0);
        let failing = |item: &u32| {
            begun.fetch_add(1, Ordering::Relaxed);
            anyhow::ensure!(*item != 3, "item {item}");
            Ok(())
        };
        let error = parallel_map(&items, 1, failing, || ()).expect_err("an error");
        assert_eq!(error.to_string(), "item 3");
        assert_eq!(begun.into_inner(), 4);
    }
}
