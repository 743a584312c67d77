"""Fits a campaign of very many impacts with Dask: each task fits one shard into a file of its own.

    python dask_fit.py CAMPAIGN PARTS [SHARDS] [WORKERS]

PARTS becomes a folder of Parquet files, which is one table. On a cluster, replace LocalCluster by
one that starts workers there (dask-jobqueue, dask-kubernetes); all of them must see CAMPAIGN and
PARTS. A task that is repeated, because a worker was lost, replaces its file.
"""

import resource
import sys
import time
from pathlib import Path

import polars as pl
import windfall as wf
from dask.distributed import Client, LocalCluster, as_completed


def fit_shard(campaign, parts, shard, shards):
    """Fits one shard; the processor time that it took, and the most memory of its worker."""
    begun = time.process_time()
    name = f"{shard:0{len(str(shards))}}.parquet"
    wf.fit_campaign(
        campaign,
        law="kuwabara-kono",
        shard=f"{shard}/{shards}",
        out=Path(parts) / name,
        threads=1,
    )
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return time.process_time() - begun, memory


def main(campaign, parts, shards=64, workers=2):
    Path(parts).mkdir(parents=True, exist_ok=True)
    with LocalCluster(n_workers=workers, threads_per_worker=1) as cluster, Client(cluster) as client:
        begun = time.perf_counter()
        tasks = [
            client.submit(fit_shard, campaign, parts, shard, shards, pure=False)
            for shard in range(1, shards + 1)
        ]
        done = [result for _, result in as_completed(tasks, with_results=True)]
        elapsed = time.perf_counter() - begun
    times, memory = zip(*done)
    print(f"{elapsed:.1f} s, {sum(times):.1f} s of processor time, {max(memory):.0f} MiB a worker")

    fits = pl.read_parquet(f"{parts}/*.parquet").filter(pl.col("left_out").is_null())
    print(fits.select(pl.len().alias("impacts"), pl.median("k"), pl.median("c"), pl.std("k").alias("sd of k")))


if __name__ == "__main__":
    main(*sys.argv[1:3], *map(int, sys.argv[3:]))
