package skein.cluster

import java.util.Locale
import skein.blocks.WorkerRecord

/** Where a coordinator's work stands, as Prometheus reads it: its text format, version 0.0.4. Rates are
  * Prometheus' own to take, for example `rate(skein_worker_blocks_counted_total[1m])`.
  */
private[cluster] object Metrics:
  val ContentType = "text/plain; version=0.0.4; charset=utf-8"

  /** Workers that are listed, those that did most; the others are counted together. */
  private val MostWorkers = 1000

  /** @param members processes of the cluster, the coordinator's own among them
    */
  def text(progress: ClusterProgress, members: Int): String =
    val state            = progress.coordinator
    val (listed, others) = state.workers.toVector
      .sortBy((name, record) => (-record.accepted, name))
      .splitAt(MostWorkers)
    import state.counts.{accepted, doubled, lost, overdue, repeated}
    val out = StringBuilder()

    def family(name: String, kind: String, help: String)(values: (Seq[(String, String)], Double)*): Unit =
      out ++= s"# HELP skein_$name $help\n# TYPE skein_$name $kind\n"
      for (labels, value) <- values do
        val text = labels.map((key, word) => s"$key=\"${escaped(word)}\"").mkString(",")
        out ++= s"skein_$name${if text.isEmpty then "" else s"{$text}"} ${number(value)}\n"
    def gauge(name: String, help: String, value: Long)   = family(name, "gauge", help)(Nil -> value.toDouble)
    def counter(name: String, help: String, value: Long) =
      family(name, "counter", help)(Nil -> value.toDouble)

    counter("blocks_counted_total", "Blocks whose first answer came.", accepted)
    counter("blocks_resumed_total", "Blocks whose answers were in the ledger already.", progress.resumed)
    counter("blocks_repeated_total", "Answers that were not a block's first.", repeated)
    counter("blocks_doubled_total", "Blocks given to a second worker since nothing else waited.", doubled)
    counter("blocks_lost_total", "Blocks that waited again since their worker was gone.", lost)
    counter("blocks_overdue_total", "Blocks that waited again since nobody answered for too long.", overdue)
    gauge("blocks_waiting", "Blocks that nobody has.", state.waiting.size)
    gauge("blocks_given_out", "Blocks that somebody has.", state.leases.size)
    gauge("round_blocks", "Blocks of the round under way.", progress.of)
    gauge("round_blocks_done", "Blocks of the round under way that have their answers.", progress.done)
    gauge("cluster_members", "Processes of the cluster, the coordinator's own among them.", members)
    gauge("workers", "Workers that are here.", progress.here)
    gauge("worker_cores", "Cores of the workers that are here.", state.cores)
    counter("workers_joined_total", "Workers that ever joined.", state.workers.size)
    counter("workers_lost_total", "How often a worker was lost.", progress.died)
    gauge("ledger_bytes", "Size of the file with the answers that count.", progress.ledgerBytes)
    val heard = kinds(progress.traffic.heard)
    val said  = kinds(progress.traffic.said)
    family("messages_heard_total", "counter", "Messages from workers, by their kind.")(heard*)
    family("messages_said_total", "counter", "Messages to workers, by their kind.")(said*)

    def each(name: String, help: String)(value: WorkerRecord => Double) =
      family(name, "counter", help)(listed.map((worker, record) => Seq("worker" -> worker) -> value(record))*)
    each("worker_blocks_counted_total", "Blocks of which this worker's answer counts.")(_.accepted.toDouble)
    each(
      "worker_blocks_repeated_total",
      "This worker's answers that were not the first."
    )(_.repeated.toDouble)
    each("worker_busy_seconds_total", "Of cores, over all of this worker's answers.")(_.busyNanos * 1e-9)
    gauge("workers_unlisted", s"Workers beyond the $MostWorkers that are listed.", others.size)
    out.result()

  private def kinds(counts: Map[String, Long]): Seq[(Seq[(String, String)], Double)] =
    counts.toVector.sortBy(_._1).map((kind, count) =>
      Seq("kind" -> kind.toLowerCase(Locale.ROOT)) -> count.toDouble
    )

  private def escaped(word: String): String =
    word.replace("\\", "\\\\").replace("\"", "\\\"").replace("\n", "\\n")

  private def number(value: Double): String =
    if value == value.toLong then value.toLong.toString else value.toString
