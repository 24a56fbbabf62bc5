//! Parallel loops whose results do not depend on the number of threads: work is cut into blocks whose size depends on the
//! scene alone, each block writes its own output, and outputs are put together in the order of the blocks.

mod shared;

pub use shared::as_atomic;

use rayon::prelude::*;
use std::ops::Range;

/// Items in a block of a sum. It decides how sums are rounded.
pub const BLOCK: usize = 4096;
/// Items in a block of a streaming loop.
const STREAM: usize = 2048;
/// Up to so many items a streaming loop runs on the calling thread, without any hand-over.
const ALONE: usize = 4096;

/// Whether streaming loops over so many items run on the calling thread.
pub fn is_alone(count: usize) -> bool {
    count <= ALONE
}

/// Items in a block of a streaming loop over so many.
pub fn stream_block(count: usize) -> usize {
    if count <= ALONE { ALONE } else { STREAM }
}

/// Runs `f(index of the block's first item, block)` over blocks of `items`.
pub fn for_each_block<T: Send>(items: &mut [T], f: impl Fn(usize, &mut [T]) + Sync) {
    if items.len() <= ALONE {
        return f(0, items);
    }
    items.par_chunks_mut(STREAM).enumerate().for_each(|(i, block)| f(i * STREAM, block));
}

/// Runs `f` over blocks of two slices of equal length.
pub fn for_each_block2<A: Send, B: Send>(a: &mut [A], b: &mut [B], f: impl Fn(usize, &mut [A], &mut [B]) + Sync) {
    debug_assert_eq!(a.len(), b.len());
    if a.len() <= ALONE {
        return f(0, a, b);
    }
    let blocks = a.par_chunks_mut(STREAM).zip(b.par_chunks_mut(STREAM)).enumerate();
    blocks.for_each(|(i, (a, b))| f(i * STREAM, a, b));
}

/// Runs `f(block of items, output)` with one output per block of `size` items; `outputs` grows to the number of blocks and
/// keeps its memory. Returns the number of blocks.
pub fn blocks_into<T: Sync, O: Default + Send>(
    items: &[T],
    size: usize,
    outputs: &mut Vec<O>,
    f: impl Fn(&[T], &mut O) + Sync,
) -> usize {
    let count = items.len().div_ceil(size);
    if outputs.len() < count {
        outputs.resize_with(count, O::default);
    }
    if count == 1 {
        f(items, &mut outputs[0]);
    } else {
        outputs[..count].par_iter_mut().zip(items.par_chunks(size)).for_each(|(out, block)| f(block, out));
    }
    count
}

/// Sum of `f` over all indices, in fixed blocks in a fixed order.
pub fn sum_blocks(count: usize, f: impl Fn(usize) -> f64 + Sync) -> f64 {
    let block = |b: usize| (b * BLOCK..((b + 1) * BLOCK).min(count)).map(&f).sum::<f64>();
    let blocks = count.div_ceil(BLOCK);
    if blocks <= 1 {
        return block(0);
    }
    let parts: Vec<f64> = (0..blocks).into_par_iter().map(block).collect();
    parts.into_iter().sum()
}

/// Runs `f(range of indices, output)` over ranges of `size` of the indices below `count`, with one output per range; `outputs`
/// grows to the number of ranges and keeps its memory. Returns the number of ranges. A single range runs on the calling
/// thread, without any hand-over.
pub fn ranges_into<O: Default + Send>(
    count: usize,
    size: usize,
    outputs: &mut Vec<O>,
    f: impl Fn(Range<usize>, &mut O) + Sync,
) -> usize {
    let ranges = count.div_ceil(size);
    if outputs.len() < ranges {
        outputs.resize_with(ranges, O::default);
    }
    let range = |i: usize| i * size..((i + 1) * size).min(count);
    if ranges == 1 {
        f(range(0), &mut outputs[0]);
    } else {
        outputs[..ranges].par_iter_mut().enumerate().for_each(|(i, out)| f(range(i), out));
    }
    ranges
}

/// Cuts consecutive pieces off a slice.
pub fn cut<'a, T>(rest: &mut &'a mut [T], length: usize) -> &'a mut [T] {
    let (piece, after) = std::mem::take(rest).split_at_mut(length);
    *rest = after;
    piece
}
