#!/usr/bin/env bash
# Encodes a library of meshes as a Slurm array: each task is one shard of `gim batch`.
#
#   sbatch --array=1-16 tools/slurm/batch.sh LIST|DIR OUT_DIR [options of gim batch]
#
# Without --array, it is a job of one task. Ask for processors and memory as for any job: --cpus-per-task=8 --mem=16G. LIST, the
# meshes and OUT_DIR must be seen by all nodes. A task that is killed, or whose node fails, may be started again (--requeue):
# it goes on where it was. Run the same command again to encode what failed. GIM names the program; default: gim.
#
# The tasks share no manifest, so OUT_DIR may be on a network file system. The last task to end writes OUT_DIR/report.html with
# all rows.
#SBATCH --job-name=gim-batch
#SBATCH --array=1-1
#SBATCH --signal=B:TERM@60
#SBATCH --requeue
set -euo pipefail

if [ $# -lt 2 ]; then
    echo "usage: sbatch --array=1-N $0 LIST|DIR OUT_DIR [options of gim batch]" >&2
    exit 2
fi
if [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then
    echo "$0: start this with sbatch" >&2
    exit 2
fi
if [ "${SLURM_ARRAY_TASK_MIN:-1}" != 1 ] || [ "${SLURM_ARRAY_TASK_COUNT:-1}" != "${SLURM_ARRAY_TASK_MAX:-1}" ]; then
    echo "$0: the array must be 1-N, so that its tasks are all shards" >&2
    exit 2
fi
mkdir -p "$2"
# The processors of the job, unless the options say otherwise. Without a plugin that binds tasks, gim would see all of the node.
jobs=(--jobs "${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}")
case " $* " in *" --jobs"* | *" --threads"*) jobs=() ;; esac
# exec: the signal before the time limit, and that of scancel, reach the program itself.
exec "${GIM:-gim}" batch "$@" --shard "$SLURM_ARRAY_TASK_ID/${SLURM_ARRAY_TASK_COUNT:-1}" \
    --log "$2/gim-batch-$SLURM_ARRAY_TASK_ID.jsonl" "${jobs[@]}"
