#!/usr/bin/env bash
# Sourced. A Slurm of one node on loopback, in a folder of its own: start_cluster FOLDER, stop_cluster.

CLUSTER_PIDS=()

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

write_slurm_conf() {
    local folder=$1 host user
    host=$(hostname -s)
    user=$(id -un)
    cat >"$folder/slurm.conf" <<CONF
ClusterName=gim
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
MinJobAge=300
ReturnToService=2
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=10 State=UP
CONF
}

# wait_until SECONDS COMMAND...
wait_until() {
    local tries=$(($1 * 5))
    shift
    while ! "$@" >/dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.2
    done
}

is_idle() { [ "$(sinfo -h -o %T)" = idle ]; }

start_cluster() {
    local folder=$1
    mkdir -p "$folder/state" "$folder/spool"
    chmod 755 "$folder"
    dd if=/dev/urandom of="$folder/munge.key" bs=1024 count=1 status=none
    chmod 600 "$folder/munge.key"
    munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
        --pid-file="$folder/munge.pid" --seed-file="$folder/munge.seed" --log-file="$folder/munge.log" >"$folder/munged.out" 2>&1 &
    CLUSTER_PIDS+=($!)
    wait_until 10 test -S "$folder/munge.socket" || return 1
    write_slurm_conf "$folder"
    export SLURM_CONF="$folder/slurm.conf"
    slurmctld -D >"$folder/slurmctld.out" 2>&1 &
    CLUSTER_PIDS+=($!)
    wait_until 20 scontrol ping || return 1
    slurmd -D >"$folder/slurmd.out" 2>&1 &
    CLUSTER_PIDS+=($!)
    wait_until 20 is_idle
}

stop_cluster() {
    local i
    for ((i = ${#CLUSTER_PIDS[@]} - 1; i >= 0; --i)); do
        kill "${CLUSTER_PIDS[i]}" 2>/dev/null && wait "${CLUSTER_PIDS[i]}" 2>/dev/null
    done
    CLUSTER_PIDS=()
}
