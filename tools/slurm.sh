#!/usr/bin/env bash
# make test-slurm: the smoke workflow as jobs of a Slurm of one machine, and its results beside those of a local run.
# Needs root on Debian: it installs slurm-wlm and munge, and starts a controller and a daemon, which it stops at the end.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

snakemake=(.venv/bin/snakemake "$@" --configfile config/smoke.yaml)
folder=results-slurm
state=$(mktemp -d)
conf=/etc/slurm/slurm.conf # jobs look for it there
export PATH="$PWD/.venv/bin:$PATH"

[ -e "$conf" ] && { echo "$conf is there: this host has a Slurm of its own; use profiles/slurm" >&2; exit 1; }
command -v slurmctld slurmd munged >/dev/null || apt-get install --yes --quiet slurm-wlm munge

stop() { pkill -x slurmd || true; pkill -x slurmctld || true; pkill -x munged || true; sleep 2; rm -rf "$state" "$conf"; }
trap stop EXIT

[ -s /etc/munge/munge.key ] || mungekey --create
mkdir -p /run/munge /var/log/munge "$state/ctld" "$state/d"
chown -R munge: /run/munge /var/log/munge /etc/munge
pgrep -x munged >/dev/null || su -s /bin/sh munge -c munged

mkdir -p /etc/slurm
cat > "$conf" <<CONF
ClusterName=one
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
StateSaveLocation=$state/ctld
SlurmdSpoolDir=$state/d
SlurmctldLogFile=$state/ctld.log
SlurmdLogFile=$state/d.log
SlurmctldPidFile=$state/ctld.pid
SlurmdPidFile=$state/d.pid
ReturnToService=2
MinJobAge=3600
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(awk '/MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld
slurmd
for _ in $(seq 30); do sinfo --noheader --states=idle 2>/dev/null | grep -q main && break; sleep 1; done
sinfo

# The queue tells what became of a job: there is no accounting. The default profile is for one machine.
"${snakemake[@]}" --workflow-profile profiles/slurm --config "results_dir=$folder" "report_dir=$folder/report" \
    "site_dir=$folder/site" --jobs 8 --cores 2 --slurm-status-command squeue --slurm-init-seconds-before-status-checks 2 \
    --seconds-between-status-checks 2 --default-resources slurm_partition=main runtime=20 mem_mb=1500
"${snakemake[@]}" -j2

# Run times differ; all else must not.
timed=$(python -c 'import yaml; from fracstudy.config import read_config
c = yaml.safe_load(open("config/study.yaml")); _, s = read_config(c | {"smoke": True, "grids": None})
print("|".join(n for n, one in s.items() if one.all_benchmarks or any(s[o].all_benchmarks for o in one.tables)))')
different=0 count=0
for file in $(cd results-smoke && find runs tables -name '*.nc' -o -name '*.csv' | sort); do
    [[ $(basename "$file" .csv) =~ ^($timed)$ ]] && continue
    count=$((count + 1))
    cmp -s "results-smoke/$file" "$folder/$file" || { echo "differs: $file"; different=1; }
done
echo "$count files of runs and tables compared"
exit "$different"
