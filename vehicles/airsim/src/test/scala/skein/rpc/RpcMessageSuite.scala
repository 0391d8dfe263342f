package skein.rpc

import scala.util.Random
import upack.*

class RpcMessageSuite extends munit.FunSuite:

  test("the oracle reads what the writer encodes"):
    for seed <- 1 to 100 do
      val random = Random(seed)
      val params = Seq.fill(random.nextInt(20))(Wire.randomMsg(random))
      val writer = MessageWriter()
      writer.request(random.nextLong(1L << 32), "méthode", params)
      val read = Wire.unpack(writer.take().toArray).asArrayValue
      assertEquals(read.size, 4, s"seed $seed")
      assertEquals(read.get(3), Wire.toValue(Arr(params*)), s"seed $seed")

  test("a reply's result is read as the oracle encoded it"):
    for seed <- 1 to 100 do
      val random = Random(seed)
      val result = Wire.randomMsg(random)
      RpcMessage.fromServer(Wire.pack(Arr(Int32(1), Int32(7), Null, result))) match
        case RpcMessage.Reply(7, Null, read: Msg) =>
          assertEquals(Wire.toValue(read), Wire.toValue(result), s"seed $seed")
        case other => fail(s"$other, seed $seed")

  test("the id and method of a call are read from its first bytes"):
    val call = Wire.pack(Arr(Int32(0), Int32(70_000), Str("simSetMesh"), Arr(Binary(new Array[Byte](100)))))
    assertEquals(RpcMessage.headOf(call.take(30)), Some((id = Some(70_000L), method = "simSetMesh")))
    assertEquals(RpcMessage.headOf(call.take(8)), None)
    assertEquals(
      RpcMessage.headOf(Wire.pack(Arr(Int32(2), Str("ping"), Arr()))),
      Some((id = None, method = "ping"))
    )
    assertEquals(RpcMessage.headOf(Wire.pack(Obj())), None)

  test("an id is read in every form of an integer; a notification has none"):
    val forms = Seq("07", "cc07", "cd0007", "ce00000007", "cf0000000000000007", "d007", "d30000000000000007")
    for array <- Seq("94", "dc0004", "dd00000004"); id <- forms do
      val call = java.util.HexFormat.of.parseHex(s"${array}00${id}a16190")
      assertEquals(RpcMessage.idIn(call), Some(7L), id)
    assertEquals(RpcMessage.idIn(Wire.pack(Arr(Int32(2), Str("ping"), Arr()))), None)

  test("integers take their shortest form at every boundary"):
    val edges = (0 to 63).flatMap(bit => Seq(1L << bit, (1L << bit) - 1, -(1L << bit), -(1L << bit) - 1))
    for edge <- edges do
      val writer = MessageWriter()
      writer.reply(0, Right(Int64(edge)))
      val ours = writer.take().toArray.drop(4)
      assertEquals(ours.toSeq, Wire.pack(Int64(edge)).toSeq, s"$edge")

  test("binary and strings take their shortest form at every boundary"):
    for length <- Seq(0, 1, 31, 32, 255, 256, 65535, 65536) do
      for value <- Seq(Binary(Array.fill[Byte](length)(7)), Str("a" * length)) do
        val writer = MessageWriter()
        writer.reply(0, Right(value))
        assertEquals(writer.take().toArray.drop(4).toSeq, Wire.pack(value).toSeq, s"$length")

  test("all messages written since the last take are taken together, once"):
    val writer = MessageWriter()
    writer.request(1, "a", Seq(Binary(new Array[Byte](100_000))))
    writer.request(2, "b", Seq(Null))
    writer.reply(2, Left("no"))
    val length = writer.length
    val taken  = writer.take()
    assertEquals(taken.length, length)
    assertEquals(writer.take().length, 0)
    val frames = Wire.framed(Framer(), Seq(taken)).collect { case Framed.Complete(bytes) => bytes }
    assertEquals(
      frames.map(RpcMessage.fromClient).map(_.productPrefix),
      Seq("Request", "Request", "Request")
    )
    assertEquals(RpcMessage.fromClient(Wire.notification("c")).productPrefix, "Notification")

  test("requests and notifications are distinguished by their length, whatever the type field is"):
    val params = Arr(Int32(1))
    assertEquals(
      fromClient(Arr(Str("?"), Int64(0xffffffffL), Str("f"), params)),
      RpcMessage.Request(0xffffffffL, "f", Vector(Int32(1)))
    )
    assertEquals(fromClient(Arr(Int32(9), Str("f"), params)), RpcMessage.Notification("f", Vector(Int32(1))))

  test("a method name may be sent as binary, params as nil or an empty map"):
    val none = RpcMessage.Request(1, "ping", Vector.empty)
    assertEquals(fromClient(Arr(Int32(0), Int32(1), Binary("ping".getBytes), Arr())), none)
    assertEquals(fromClient(Arr(Int32(0), Int32(1), Str("ping"), Null)), none)
    assertEquals(fromClient(Arr(Int32(0), Int32(1), Str("ping"), Obj())), none)

  test("arrays of another length, maps and integers are ignored"):
    assertEquals(fromClient(Arr(Int32(0), Int32(1))), RpcMessage.Ignored("an array of 2"))
    assertEquals(fromClient(Obj(Str("a") -> Null)), RpcMessage.Ignored("a map"))
    assertEquals(fromClient(Int32(5)), RpcMessage.Ignored("an integer"))
    assertEquals(fromServer(Arr(Int32(2), Str("f"), Arr())), RpcMessage.Ignored("an array of 3"))

  test("an id that is a string, negative or beyond 32 bits is malformed"):
    def request(id: Msg) = fromClient(Arr(Int32(0), id, Str("f"), Arr()))
    assertEquals(request(Str("7")), RpcMessage.Malformed("an id that is a string"))
    assertEquals(request(Int32(-1)), RpcMessage.Malformed("a negative id: -1"))
    assertEquals(request(Int64(1L << 32)), RpcMessage.Malformed("an id outside 0 to 2^32 - 1: 4294967296"))
    assertEquals(
      request(UInt64(-1)),
      RpcMessage.Malformed("an id outside 0 to 2^32 - 1: 18446744073709551615")
    )

  test("a method name that is not a string, and params that are not a list, are malformed"):
    assertEquals(
      fromClient(Arr(Int32(0), Int32(1), Int32(2), Arr())),
      RpcMessage.Malformed("a method name that is an integer")
    )
    assertEquals(
      fromClient(Arr(Int32(0), Int32(1), Str("f"), Str("x"))),
      RpcMessage.Malformed("params that are a string")
    )

  private def fromClient(msg: Msg) = RpcMessage.fromClient(Wire.pack(msg))
  private def fromServer(msg: Msg) = RpcMessage.fromServer(Wire.pack(msg))
