package skein.buffer

import java.util.SplittableRandom
import org.apache.pekko.util.ByteString
import upack.{Arr, Binary, Int32, Int64, Msg, Null, Obj, Str, True}

class ClientCallsSuite extends munit.FunSuite:

  private def bytes(messages: Msg*): ByteString = ByteString(messages.flatMap(upack.write(_).toSeq).toArray)

  private def request(id: Int, method: String, params: Msg*): Msg =
    Arr(Int32(0), Int32(id), Str(method), Arr(params*))

  private val none  = Seq.empty[Msg]
  private val state = request(1, "getMultirotorState", Str("Evader"))
  private val plan  = request(2, "skeinFollowPlan", Int64(7), Arr(none*), Str("Evader"))
  private val hover = request(3, "hover", Str("Evader"))
  private val image = request(4, "simSetMesh", Binary(new Array[Byte](150_000)))
  private val long  = request(5, "skeinFollowPlan", Binary(new Array[Byte](100_000)))
  private val path  = request(6, "moveOnPath", Binary(new Array[Byte](80_000)))
  private val told  = Arr(Int32(2), Str("reset"), Arr(none*))

  private def cut(whole: ByteString, most: Int, random: SplittableRandom): Vector[ByteString] =
    Vector.unfold(whole): left =>
      Option.when(left.nonEmpty)(left.splitAt(1 + random.nextInt(math.min(most, left.size))))

  private def passed(pieces: Vector[Piece]): ByteString = pieces.foldLeft(ByteString.empty):
    case (before, Piece.Rest(bytes))       => before ++ bytes
    case (before, Piece.Call(_, _, bytes)) => before ++ bytes

  private def assertSame(one: ByteString, other: ByteString, seed: Long): Unit =
    assert(java.util.Arrays.equals(one.toArray, other.toArray), s"seed $seed")

  private def called(pieces: Vector[Piece]) = pieces.collect { case Piece.Call(wish, id, _) => (wish, id) }

  private val messages = Vector(state, plan, hover, image, Null, path, Obj(Str("x") -> True), told, plan)

  for most <- Seq(100, 5_000, 200_000) do
    test(s"all bytes pass in order, and calls are found, in pieces of up to $most bytes"):
      for seed <- 1L to 30 do
        val calls  = ClientCalls()
        val pieces = cut(bytes(messages*), most, SplittableRandom(seed)).flatMap(calls.offer)
        assertSame(passed(pieces), bytes(messages*), seed)
        val wishes = called(pieces).map((wish, id) => (wish.ordinal, id))
        val plans  = Wish.Plan(Left("")).ordinal
        assertEquals(
          wishes,
          Vector(
            (plans, Some(2L)),
            (Wish.Hover("").ordinal, Some(3L)),
            (Wish.Reset.ordinal, None),
            (Wish.Reset.ordinal, None),
            (plans, Some(2L))
          ),
          s"seed $seed"
        )

  test("a plan that is too long is removed and refused, and later bytes pass"):
    for seed <- 1L to 30 do
      val calls  = ClientCalls()
      val pieces = cut(bytes(state, long, state), 50_000, SplittableRandom(seed)).flatMap(calls.offer)
      assertSame(passed(pieces), bytes(state, state), seed)
      called(pieces) match
        case Vector((Wish.Plan(Left(text)), Some(5L))) => assert(text.contains("65536 bytes"), text)
        case other                                     => fail(s"seed $seed: $other")

  test("at most 64 KiB of a long message are held"):
    val calls = ClientCalls()
    var sent  = 0
    var gone  = 0
    for piece <- bytes(image).grouped(1000) do
      sent += piece.size
      gone += passed(calls.offer(piece)).size
      assert(sent - gone < Wish.MostBytes + 1000, s"${sent - gone} bytes held of $sent")
    assertEquals(gone, bytes(image).size)

  test("bytes that are not MessagePack pass, and so do all later ones"):
    val calls  = ClientCalls()
    val begun  = bytes(plan).take(1)
    val broken = ByteString(0xc1) ++ bytes(plan)
    assertEquals(passed(calls.offer(begun)), ByteString.empty)
    assertEquals(calls.offer(broken), Vector(Piece.Rest(begun ++ broken)))
    assert(calls.isLost)
    assertEquals(calls.offer(bytes(plan)), Vector(Piece.Rest(bytes(plan))))

  test("a call is classified by its effect on plans, with its vehicle"):
    def wish(method: String, params: Msg*) = Wish.of(method, params.toVector)
    assertEquals(wish("moveByVelocityZ", Int32(1), Str("A")), Some(Wish.Move("A")))
    assertEquals(wish("takeoff", Int32(20), Binary("A".getBytes)), Some(Wish.Move("A")))
    assertEquals(wish("hover", Str("")), Some(Wish.Hover("")))
    assertEquals(wish("cancelLastTask", Str("A")), Some(Wish.Stop("A")))
    assertEquals(wish("enableApiControl", upack.False, Str("A")), Some(Wish.Stop("A")))
    assertEquals(wish("enableApiControl", True, Str("A")), None)
    assertEquals(wish("skeinHoverAt", Null, Str("A")), Some(Wish.Place("A")))
    assertEquals(wish("reset"), Some(Wish.Reset))
    assertEquals(wish("simGetImages", Arr(none*), Str("A")), None)
    assertEquals(
      wish("skeinFollowPlan"),
      Some(
        Wish.Plan(Left("rpclib: client error C0002: Function 'skeinFollowPlan' was called with an invalid " +
          "number of arguments. Expected: 0, got: 3"))
      )
    )
