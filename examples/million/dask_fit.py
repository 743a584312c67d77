"""Fits campaigns of very many impacts with Dask: each task fits one part into a file of its own.

    python dask_fit.py PARTS SHARDS WORKERS CAMPAIGN...

PARTS becomes a folder of Parquet files, which is one table. On a cluster, replace LocalCluster by
one that starts workers there (dask-jobqueue, dask-kubernetes); all of them must see the campaigns
and PARTS. A task that is repeated because a worker was lost replaces its file.
"""

import resource
import sys
import time
from pathlib import Path

import polars as pl
import windfall as wf
from dask.distributed import Client, LocalCluster, as_completed


def fit_shard(campaign, out, shard, shards):
    """Fits one part; the processor time that it took, and the most memory that its worker had."""
    begun = time.process_time()
    wf.fit_campaign(campaign, law="kuwabara-kono", shard=f"{shard}/{shards}", out=out, threads=1)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return time.process_time() - begun, memory


def main(parts, shards, workers, *campaigns):
    Path(parts).mkdir(parents=True, exist_ok=True)
    cluster = LocalCluster(n_workers=int(workers), threads_per_worker=1)
    with cluster, Client(cluster) as client:
        begun = time.perf_counter()
        tasks = [
            client.submit(
                fit_shard,
                campaign,
                Path(parts).resolve() / f"{Path(campaign).name}-{shard:05}.parquet",
                shard,
                int(shards),
                pure=False,
            )
            for campaign in campaigns
            for shard in range(1, int(shards) + 1)
        ]
        done = [result for _, result in as_completed(tasks, with_results=True)]
        elapsed = time.perf_counter() - begun
    times, memory = zip(*done)
    print(f"{elapsed:.1f} s, {sum(times):.1f} s of processor time, {max(memory):.0f} MiB a worker")

    fits = pl.read_parquet(f"{parts}/*.parquet").filter(pl.col("left_out").is_null())
    print(fits.group_by("law").agg(pl.len(), pl.median("k"), pl.median("c")))


if __name__ == "__main__":
    main(*sys.argv[1:])
