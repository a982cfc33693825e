#!/usr/bin/env bash
# Runs tools/slurm/batch.sh on a Slurm of one node, started on loopback. Skips, and says so, where Slurm cannot start.
# Usage: run.sh GIM GIM_CORPUS
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/setup.sh"
source "$(dirname "${BASH_SOURCE[0]}")/cluster.sh"
readonly GIM=$1 CORPUS=$2 SCRIPT="$GIM_ROOT/tools/slurm/batch.sh" MESHES=24 TASKS=4
export GIM
work=$(mktemp -d)
readonly work
finish() {
    stop_cluster
    rm -rf "$work"
}
trap finish EXIT

make_meshes() {
    local i
    mkdir -p "$work/meshes"
    "$CORPUS" sphere-108 "$work/sphere.ply"
    for ((i = 1; i <= MESHES; ++i)); do
        # Each has another first coordinate, so no two files have the same bytes.
        awk -v scale="1.$i" 'NF == 3 && /^[-0-9]/ { $1 *= scale } { print }' "$work/sphere.ply" >"$work/meshes/$i.ply"
    done
}

# A job that ends in another way than with status 0 gives `sbatch --wait` that status.
submit() { (cd "$work" && sbatch --wait --output="$work/job-%a.out" "$@"); }

count_results() { cat "$work/out"/gim-batch-*.jsonl | grep -c "\"result\":\"$1\"" || true; }

expect() {
    [ "$2" = "$3" ] || {
        tail -n 5 "$work"/job-*.out "$work"/cluster/slurmd.log
        die "$1: expected $2, found $3"
    }
}

mkdir "$work/cluster"
say "A Slurm of one node"
if ! start_cluster "$work/cluster"; then
    tail -n 3 "$work"/cluster/*.log "$work"/cluster/*.out || true
    say "Skipped: Slurm cannot start here, so tools/slurm stays untested"
    exit 0
fi
make_meshes
readonly OPTIONS=(--layout gim --size 17)

say "An array of $TASKS tasks"
submit --array=1-$TASKS "$SCRIPT" "$work/meshes" "$work/out" "${OPTIONS[@]}" --jobs 1 || die "the job failed: $(cat "$work"/job-*.out)"
expect "encoded" $MESHES "$(count_results encoded)"
expect "outputs" $MESHES "$(find "$work/out" -name '*.gim' | wc -l)"
expect "manifests" $TASKS "$(find "$work/out" -name '*.sqlite' | wc -l)"
expect "rows of the report" $MESHES "$(grep -c '<td class="text done">' "$work/out/report.html")"
cmp <("$GIM" encode "$work/meshes/7.ply" - --layout gim --size 17 --quiet) "$work/out/7.ply.gim" || die "other bytes than gim encode"

say "The same job with a bad input"
echo "no mesh" >"$work/meshes/bad.ply"
! submit --array=1-$TASKS "$SCRIPT" "$work/meshes" "$work/out" "${OPTIONS[@]}" || die "a failed input did not fail the job"
expect "encoded" $MESHES "$(count_results encoded)"
expect "failed" 1 "$(count_results failed)"

say "A job of one task takes over"
rm "$work/meshes/bad.ply"
submit "$SCRIPT" "$work/meshes" "$work/out" "${OPTIONS[@]}" || die "the job failed: $(cat "$work"/job-*.out)"
expect "encoded" $MESHES "$(count_results encoded)"

say "A wrong array is refused"
! submit --array=3-4 "$SCRIPT" "$work/meshes" "$work/out" "${OPTIONS[@]}" || die "an array that is not 1-N was taken"
say "The cluster passes"
