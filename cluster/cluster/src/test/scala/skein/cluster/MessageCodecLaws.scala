package skein.cluster

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.actor.typed.ActorRef
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.scalacheck.{Arbitrary, Gen, Prop}
import scala.collection.immutable.ArraySeq
import scala.concurrent.Await
import scala.concurrent.duration.DurationInt

class MessageCodecLaws extends munit.ScalaCheckSuite:
  private lazy val system                     = ActorSystem("codec")
  private lazy val nobody: ActorRef[ToWorker] = system.deadLetters.toTyped
  private lazy val codec                      =
    MessageCodec(
      _ => "nobody",
      name => if name == "nobody" then nobody else throw IllegalArgumentException(name)
    )

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 10.seconds)

  private val text   = Gen.alphaNumStr
  private val number = Arbitrary.arbitrary[Long]
  private val blob   = Gen.listOf(Arbitrary.arbitrary[Byte]).map(ArraySeq.from)

  private val messages: Gen[Message] = Gen.oneOf(
    for
      worker  <- text; cores <- Gen.choose(1, MessageCodec.MostCores); build <- text; run <- number
      holding <- Gen.listOf(number)
    yield Message.Ask(worker, cores, build, run, holding.toSet, nobody),
    for run <- number; worker <- text; block <- number; busy <- number; answer <- blob
    yield Message.Done(run, worker, block, busy, answer),
    for run <- number; worker <- text; block <- number; why <- text
    yield Message.Failed(run, worker, block, why),
    for run <- number; worker <- text; why <- text yield Message.Unable(run, worker, why),
    for run <- number; question <- blob yield Message.Welcome(run, question),
    for run <- number; block <- number; work <- blob yield Message.Give(run, block, work),
    text.map(Message.Refused(_)),
    Gen.const(Message.Goodbye)
  )

  property("a message is read as it was written"):
    Prop.forAll(messages)(message => assertEquals(codec.message(codec.bytes(message)), Right(message)))

  property("a truncated message, or one with trailing bytes, is refused with one line"):
    Prop.forAll(messages, Gen.choose(0.0, 1.0)): (message, share) =>
      val whole = codec.bytes(message)
      assert(codec.message(whole.take((share * whole.length).toInt.min(whole.length - 1))).isLeft)
      assert(codec.message(whole :+ 0).isLeft)

  property("no bytes make the codec throw, or trust a stated size"):
    Prop.forAll(Gen.listOf(Arbitrary.arbitrary[Byte]), Gen.choose(0, 9)): (bytes, kind) =>
      codec.message((kind.toByte :: bytes).toArray): Unit

  test("no memory is allocated for a size that only a peer states"):
    for size <- Seq(Int.MaxValue, -1, MessageCodec.MostBytes, MessageCodec.MostBytes + 1) do
      val bytes = java.nio.ByteBuffer.allocate(13).put(5: Byte).putLong(1).putInt(size).array
      assert(clue(codec.message(bytes)).isLeft)
