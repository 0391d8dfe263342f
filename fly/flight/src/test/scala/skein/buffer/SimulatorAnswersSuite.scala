package skein.buffer

import java.util.SplittableRandom
import org.apache.pekko.util.ByteString
import skein.rpc.MessageWriter
import upack.{Arr, Binary, Int32, Msg, Null, Str}

class SimulatorAnswersSuite extends munit.FunSuite:

  private def answer(id: Long, result: Msg): ByteString =
    val writer = MessageWriter()
    writer.reply(id, Right(result))
    writer.take()

  private val sent = Vector(
    answer(1, Str("yes")),
    answer(70_000, Binary(new Array[Byte](200_000))),
    answer(4_000_000_000L, Null),
    answer(3, Arr(Seq.fill(1000)(Int32(300))*))
  )

  test("ends of messages and answered calls are found, wherever the bytes are cut"):
    val ends = sent.scanLeft(0)(_ + _.size)
    for seed <- 1L to 100 do
      val random  = SplittableRandom(seed)
      val answers = SimulatorAnswers()
      var left    = sent.foldLeft(ByteString.empty)(_ ++ _)
      var at      = 0
      var ids     = Vector.empty[Long]
      while left.nonEmpty do
        val (bytes, rest) = left.splitAt(1 + random.nextInt(math.min(left.size, 60_000)))
        val found         = answers.offer(bytes)
        val wanted        = ends.filter(end => end >= at && end <= at + bytes.size).lastOption.map(_ - at)
        assertEquals(found.end, wanted, s"seed $seed at $at")
        at += bytes.size
        ids ++= found.ids
        assertEquals(answers.isMidway, !ends.contains(at), s"seed $seed at $at")
        left = rest
      assertEquals(ids, Vector(1L, 70_000L, 4_000_000_000L, 3L), s"seed $seed")

  test("after bytes that are not MessagePack, no ends of messages are found"):
    val answers = SimulatorAnswers()
    assertEquals(answers.offer(answer(1, Null) ++ ByteString(0xc1)).end, Some(answer(1, Null).size))
    assert(answers.isLost && answers.isMidway)
    assertEquals(answers.offer(answer(2, Null)), (ids = Vector.empty, end = None))
