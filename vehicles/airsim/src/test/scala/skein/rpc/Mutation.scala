package skein.rpc

import scala.util.Random
import upack.*

/** Byte sequences that are similar to, or very different from, what a peer should send. */
object Mutation:

  /** A few messages of one kind, changed in a few places; one in eight is unchanged, one in eight is noise.
    */
  def of(random: Random, message: Random => Msg): Array[Byte] =
    val stream = Array.concat(Seq.fill(1 + random.nextInt(3))(Wire.pack(message(random)))*)
    random.nextInt(8) match
      case 0 => stream
      case 1 => random.nextBytes(random.nextInt(64))
      case _ => (0 to random.nextInt(3)).foldLeft(stream)((bytes, _) => mutated(bytes, random))

  def request(random: Random): Msg = random.nextInt(6) match
    case 0 => Arr(Int32(2), Str("note"), Arr(value(random)))
    case 1 => value(random)
    case _ =>
      Arr(Int32(0), Int64(random.nextInt().toLong >>> random.nextInt(32)), Str("echo"), Arr(value(random)))

  /** Usually a reply to the call with this id. */
  def reply(id: Long)(random: Random): Msg = random.nextInt(8) match
    case 0 => Arr(Int32(1), Int64(random.nextInt(100)), Null, value(random))
    case 1 => Arr(Int32(1), Int64(id), Str("refused"), Null)
    case 2 => value(random)
    case _ => Arr(Int32(1), Int64(id), Null, value(random))

  private def value(random: Random): Msg = Wire.randomMsg(random, depth = 2, longest = 40)

  /** The bytes with a change in one place. */
  def mutated(bytes: Array[Byte], random: Random): Array[Byte] =
    val at = random.nextInt(bytes.length + 1)
    random.nextInt(7) match
      case 0 if at < bytes.length => bytes.updated(at, (bytes(at) ^ (1 << random.nextInt(8))).toByte)
      case 1 if at < bytes.length => bytes.updated(at, random.nextInt(256).toByte)
      case 2                      => bytes.take(at)
      case 3 => bytes.take(at) ++ random.nextBytes(1 + random.nextInt(8)) ++ bytes.drop(at)
      case 4 => bytes.take(at) ++ bytes.drop(at + 1 + random.nextInt(8))
      case 5 => bytes.take(at) ++ Nasty(random.nextInt(Nasty.length)) ++ bytes.drop(at)
      case _ => bytes.take(at) ++ bytes.drop(bytes.length - at)

  private val Nasty: IndexedSeq[Array[Byte]] = IndexedSeq(
    "c1",
    "ddffffffff",
    "dfffffffff",
    "dd00400001",
    "c6ffffffff",
    "dbffffffff",
    "c9ffffffff00",
    "c67fffffff",
    "91919191919191919191919191919191919191919191919191919191919191919191919191919191919191" +
      "91919191919191919191919191919191919191919191919191",
    "9400a13190",
    "9400ffa16690",
    "9400cf0000000100000000a16690",
    "9400cfffffffffffffffffa16690",
    "dc0000",
    "de0000",
    "df00000000",
    "d9",
    "c40000",
    "d6ff00000000"
  ).map(java.util.HexFormat.of().parseHex(_))
