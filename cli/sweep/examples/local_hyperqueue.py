# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs S/chunks.jsonl by HyperQueue on this machine: `local_hyperqueue.py PROGRAM S [WORKERS]`.

Needs `pip install hyperqueue==0.27`. A chunk that fails does not stop the others; calling it again runs what is missing.
"""

import sys
from pathlib import Path

from hyperqueue import Job, LocalCluster
from hyperqueue.client import FailedJobsException
from hyperqueue.cluster import WorkerConfig

program, store = sys.argv[1], Path(sys.argv[2]).resolve()
workers = int(sys.argv[3]) if len(sys.argv) > 3 else 2
with LocalCluster() as cluster:
    for _ in range(workers):
        cluster.start_worker(WorkerConfig(cores=1))
    job = Job(max_fails=None, default_workdir=store)
    for line in (store / "chunks.jsonl").read_text().splitlines():
        job.program([program, "sweep", "run", "--store", str(store), line], stdout=None)
    client = cluster.client()
    try:
        client.wait_for_jobs([client.submit(job)])
    except FailedJobsException as error:
        sys.exit(str(error))
