package skein.observe

import java.util.SplittableRandom
import org.apache.pekko.util.ByteString
import skein.units.Instant
import upack.{Arr, Binary, Int32, Msg, Null, Obj, Str, UInt64}

class ConversationSuite extends munit.FunSuite:
  private val now = Instant.ofNanos(7)

  private def bytes(messages: Msg*): ByteString = ByteString(messages.flatMap(upack.write(_).toSeq).toArray)

  private def state(stampNs: Long): Msg =
    Obj(Str("kinematics_estimated") -> Obj(Str("position") -> Null), Str("timestamp") -> UInt64(stampNs))

  private val asked    = bytes(Arr(Int32(0), Int32(1), Str("getMultirotorState"), Arr(Str("Evader"))))
  private val answered = bytes(Arr(Int32(1), Int32(1), Null, state(123)))

  private def cut(whole: ByteString, random: SplittableRandom): Vector[ByteString] =
    if whole.isEmpty then Vector.empty
    else
      val (piece, rest) = whole.splitAt(1 + random.nextInt(whole.size))
      piece +: cut(rest, random)

  test("a call and its answer are understood, wherever their bytes are cut"):
    for seed <- 1L to 200 do
      val random = SplittableRandom(seed)
      val talk   = Conversation(3)
      assertEquals(
        cut(asked, random).flatMap(talk.fromClient(_, now)),
        Vector(Passed.Called(3, 1, "getMultirotorState", "Evader", now)),
        s"seed $seed"
      )
      assertEquals(
        cut(answered, random).flatMap(talk.fromSimulator(_, now)),
        Vector(Passed.Answered(3, 1, None, Some(Instant.ofNanos(123)), answered.size, now)),
        s"seed $seed"
      )

  test("the vehicle's name is found in a request for images with a flag after it"):
    val request = bytes(Arr(Int32(0), Int32(9), Str("simGetImages"), Arr(Arr(), Str("Drone"), upack.False)))
    assertEquals(
      Conversation(0).fromClient(request, now),
      Vector(Passed.Called(0, 9, "simGetImages", "Drone", now))
    )

  test("only the length of a large answer is kept, and messages behind it are understood"):
    val image = bytes(Arr(Int32(1), Int32(1), Null, Binary(new Array[Byte](3_000_000))))
    val talk  = Conversation(0)
    val found = (image ++ answered).grouped(10_000).toVector.flatMap(talk.fromSimulator(_, now))
    assertEquals(
      found.collect { case answer: Passed.Answered => answer.bytes },
      Vector(image.size.toLong, answered.size.toLong)
    )

  test("bytes that are not messages are reported once, and the rest is ignored"):
    for seed <- 1L to 500 do
      val random = SplittableRandom(seed)
      val noise  = ByteString(Array.fill(1 + random.nextInt(2_000))(random.nextInt.toByte))
      val talk   = Conversation(0)
      val found  = cut(noise, random).flatMap(talk.fromClient(_, now)) ++ talk.fromClient(noise, now)
      assert(found.count(_.isInstanceOf[Passed.Unreadable]) <= 1, s"seed $seed")
