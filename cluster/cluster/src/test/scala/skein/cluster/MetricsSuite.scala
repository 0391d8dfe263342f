package skein.cluster

import skein.blocks.{Block, Coordinator}
import scala.collection.immutable.ArraySeq

class MetricsSuite extends munit.FunSuite:

  /** `anna` answered one block of three and has the next; `ben "2"` is gone. */
  private val progress =
    val start         = Coordinator().joined("anna", 1).joined("ben \"2\"", 2)
    val offered       = start.offered(Vector.tabulate(3)(number => Block(number, ArraySeq(number.toByte))))
    val (first, _)    = offered.asked("anna", Set.empty, 0)
    val (answered, _) = first.answered("anna", 0, 1_500_000_000L)
    val (again, _)    = answered.asked("anna", Set.empty, 0)
    ClusterProgress(
      again.lost("ben \"2\""),
      done = 1,
      of = 3,
      died = 1,
      traffic = Traffic().hearing(Message.Failed(1, "anna", 0, "")).saying(Message.Goodbye),
      ledgerBytes = 1L << 40
    )
  private val text  = Metrics.text(progress, members = 2)
  private val lines = text.linesIterator.toVector

  test("tells blocks, workers, messages and the ledger"):
    for line <- Seq(
        "skein_blocks_counted_total 1",
        "skein_blocks_waiting 1",
        "skein_blocks_given_out 1",
        "skein_round_blocks 3",
        "skein_cluster_members 2",
        "skein_workers 1",
        "skein_workers_joined_total 2",
        "skein_workers_lost_total 1",
        "skein_ledger_bytes 1099511627776",
        "skein_messages_heard_total{kind=\"failed\"} 1",
        "skein_messages_said_total{kind=\"goodbye\"} 1",
        "skein_worker_busy_seconds_total{worker=\"anna\"} 1.5",
        "skein_worker_blocks_counted_total{worker=\"ben \\\"2\\\"\"} 0"
      )
    do assert(lines.contains(clue(line)), text)

  test("every line is Prometheus' text format, and no name comes twice"):
    val sample = """skein_[a-z_]+(\{[a-z]+="([^"\\\n]|\\["\\n])*"\})? [-+0-9.eE]+"""
    val about  = """# (HELP skein_[a-z_]+ .+|TYPE skein_[a-z_]+ (counter|gauge))"""
    for line <- lines do assert(line.matches(sample) || line.matches(about), line)
    val samples = lines.filterNot(_.startsWith("#")).map(_.takeWhile(_ != ' '))
    assertEquals(samples.distinct, samples)
    assert(text.endsWith("\n"))
