package skein.cli

import java.nio.file.Path
import mainargs.ParserForClass
import scala.collection.immutable.ArraySeq
import skein.blocks.Coordinator
import skein.cluster.{ClusterProgress, Tls}
import skein.link.Address

class ClusterRunSuite extends munit.FunSuite:
  private val at = Address("coordinator.lab", 25520)

  private def options(tls: Option[Tls]) = ClusterOptions.Checked(workers = 2, at, block = None, tls)

  private def read(words: Seq[String]) =
    assertEquals(words.head, "worker")
    ParserForClass[WorkerOptions].constructOrThrow(words.tail)

  test("workers of this machine get the certificates, and listen at the coordinator's host"):
    val folder = Path.of("/certificates/coordinator.lab")
    val tls    = Tls(folder.resolve(Tls.KeyStore), folder.resolve(Tls.TrustStore), "secret")
    val told   = read(ClusterRun.words(options(Some(tls)), at, threads = 4))
    assertEquals((told.join, told.threads), ("coordinator.lab:25520", Some(2)))
    assertEquals((told.tls, told.listen), (Some(folder.toString), Some("coordinator.lab:0")))
    val plain = read(ClusterRun.words(options(None), Address("127.0.0.1", 25520), threads = 4))
    assertEquals((plain.tls, plain.listen), (None, None))

  test("while another worker is here, the end of this machine's workers ends nothing"):
    val both    = Coordinator().joined("own-1", 1).joined("other-2", 1)
    val hasGone = Set("own-1")
    assert(ClusterRun.isOtherHere(ClusterProgress(both), hasGone))
    assert(!ClusterRun.isOtherHere(ClusterProgress(both.lost("other-2")), hasGone))
    assert(!ClusterRun.isOtherHere(ClusterProgress(), hasGone))

  test("a ledger's name differs by question and by build"):
    val question = ArraySeq[Byte](1, 2, 3)
    val names    = Seq((question, "one"), (question, "two"), (question.reverse, "one"))
    assertEquals(names.map(ClusterRun.ledgerName(_, _)).distinct.size, 3)
    assertEquals(ClusterRun.ledgerName(question, "one"), ClusterRun.ledgerName(question, "one"))
    assertEquals(ClusterRun.ledgerName(question, "one").length, 32)
