"""What the studies share: runs side by side, whose rows are kept in a CSV file as they come, so that a study goes on where it was stopped."""
import concurrent.futures, csv, os


def append(path, columns, rows):
    """Adds rows, dictionaries, to a CSV file that begins with the names of its columns"""
    fresh = not os.path.exists(path)
    with open(path, "a", newline="") as f:
        out = csv.DictWriter(f, columns, restval="", lineterminator="\n")
        if fresh:
            out.writeheader()
        out.writerows(rows)


def side_by_side(processes, run, cases, keep):
    """run(case) of every case, some at a time; keep(case, result, done, total) in the order in which they end. An error ends all."""
    with concurrent.futures.ThreadPoolExecutor(processes) as pool:
        runs = {pool.submit(run, case): case for case in cases}
        try:
            for done, future in enumerate(concurrent.futures.as_completed(runs), 1):
                keep(runs[future], future.result(), done, len(cases))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
