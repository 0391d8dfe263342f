package skein.cluster.jars

import java.nio.file.{Files, Path}
import java.util.zip.ZipFile
import scala.collection.immutable.ArraySeq
import scala.jdk.CollectionConverters.*
import scala.util.{Random, Using}
import skein.testing.TemporaryFolders

/** What is taken of a program that is offered, with a function in the place of its coordinator. */
class AcceptanceSuite extends munit.FunSuite, TemporaryFolders:

  private type Peer = (Sha256, Long) => Either[NotFetched, ArraySeq[Byte]]

  private def written(name: String, bytes: Array[Byte]): Path =
    Files.write(temporaryFolder().resolve(name), bytes)

  private def jar(seed: Int, size: Int): Path = written(s"$seed.jar", Random(seed).nextBytes(size))

  /** Longer than a piece, shorter, and empty. */
  private val (long, short, empty) = (3 * Shipment.MostPiece + 17, 1000, 0)

  private def shipped(parts: Path*)(body: Shipment => Unit): Unit =
    Using.resource(Shipment.of("ridge.Main", parts.toVector).fold(fail(_), identity))(body)

  private def honest(shipment: Shipment): Peer = (content, offset) =>
    shipment.piece(content, offset).left.map(NotFetched.Refused(_))

  private def accepting(digests: Sha256*)(own: Path*) =
    Acceptance(digests.toSet, JarStore(temporaryFolder().resolve("store")), own.toVector)

  private def refusal(came: Either[NotFetched, Fetched]): String = came match
    case Left(NotFetched.Refused(reason)) => reason
    case other                            => fail(s"expected a refusal, came $other")

  private def stored(by: Acceptance): Vector[Path] =
    if Files.exists(by.store.folder) then
      Using.resource(Files.list(by.store.folder))(_.toList.asScala.toVector)
    else Vector.empty

  test("a program comes whole, in the order of its class path; what the worker has does not come"):
    val (mine, same)  = (jar(1, long), jar(2, short))
    val also          = written("also.jar", Files.readAllBytes(same))
    val (third, none) = (jar(3, short), jar(4, empty))
    shipped(mine, same, third, none): shipment =>
      val asked = Vector.newBuilder[Sha256]
      val by    = accepting(shipment.program.digest)(also)
      val came  = by.fetch(shipment.program.digest, _ => ()): (content, offset) =>
        asked += content
        honest(shipment)(content, offset)
      val fetched = came.fold(wrong => fail(wrong.toString), identity)
      assertEquals(fetched.main, "ridge.Main")
      for (file, from) <- fetched.classPath.zip(Vector(mine, same, third, none)) do
        assertEquals(Files.mismatch(file, from), -1L)
      assertEquals(fetched.classPath(1), also)
      assert(!asked.result().contains(Sha256.of(same)), "was asked for what is here")
      // Later nothing but the list comes.
      val again = by.fetch(shipment.program.digest, _ => ()): (content, offset) =>
        assertEquals(content, shipment.program.digest)
        honest(shipment)(content, offset)
      assertEquals(again, came)

  test(
    "a folder of classes comes as a jar, the same on every machine, and counts as the same folder elsewhere"
  ):
    def classes(order: Seq[String]) =
      val folder = temporaryFolder()
      for name <- order do
        Files.createDirectories(folder.resolve(name).getParent)
        Files.writeString(folder.resolve(name), s"what $name holds")
      folder
    val names       = Seq("ridge/Main.class", "ridge/land/Hill.class", "note.txt")
    val (own, same) = (classes(names), classes(names.reverse))
    shipped(own): shipment =>
      val elsewhere = accepting(shipment.program.digest)()
      val came      = elsewhere.fetch(shipment.program.digest, _ => ())(honest(shipment))
      val jar       = came.fold(wrong => fail(wrong.toString), _.classPath.head)
      Using.resource(ZipFile(jar.toFile)): archive =>
        assertEquals(archive.stream.map(_.getName).toList.asScala.toSeq, names.sorted)
        for entry <- archive.entries.asScala do
          val held =
            Using.resource(archive.getInputStream(entry))(stream => String(stream.readAllBytes(), "UTF-8"))
          assertEquals(held, s"what ${entry.getName} holds")
      val here =
        accepting(shipment.program.digest)(same).fetch(shipment.program.digest, _ => ())(honest(shipment))
      assertEquals(here.map(_.classPath), Right(Vector(same)))

  test("a program that was not accepted is not asked for"):
    shipped(jar(1, short)): shipment =>
      def never: Peer = (_, _) => fail("was asked")
      assert(clue(refusal(accepting()().fetch(
        shipment.program.digest,
        _ => ()
      )(never))).contains("--accept-jars"))
      val other = accepting(Sha256.of(Array[Byte](1)))()
      assert(clue(refusal(other.fetch(shipment.program.digest, _ => ())(never))).contains("another program"))

  test("another list of jars, and a jar of other bytes, are refused, and nothing of them is kept"):
    val (good, bad) = (jar(1, long), jar(2, long))
    shipped(good): shipment =>
      val digest = shipment.program.digest
      shipped(bad): wrong =>
        val swapped = accepting(digest)()
        val list    =
          refusal(swapped.fetch(digest, _ => ())((_, offset) => honest(wrong)(wrong.program.digest, offset)))
        assert(clue(list).contains("list of jars"))
        val cheated = refusal(swapped.fetch(digest, _ => ()): (content, offset) =>
          if content == digest then honest(shipment)(content, offset)
          else honest(wrong)(wrong.program.jars.head.sha256, offset))
        assert(clue(cheated).contains("other bytes"))
        assertEquals(stored(swapped), Vector.empty)

  test("a jar that ends early, goes on too long, or whose coordinator falls silent, is not kept"):
    shipped(jar(1, long)): shipment =>
      val digest          = shipment.program.digest
      def taken(of: Peer) =
        val by   = accepting(digest)()
        val came = by.fetch(digest, _ => ()): (content, offset) =>
          if content == digest then honest(shipment)(content, offset) else of(content, offset)
        assertEquals(stored(by), Vector.empty)
        came
      def nothing(offset: Long): Either[NotFetched, ArraySeq[Byte]] =
        if offset == 0 then honest(shipment)(shipment.program.jars.head.sha256, 0) else Right(ArraySeq.empty)
      assert(clue(
        refusal(taken((_, offset) => nothing(offset)))
      ).contains(s"cut off after ${Shipment.MostPiece} of $long"))
      val more = taken((content, offset) =>
        honest(shipment)(content, offset).map(_ ++ ArraySeq.fill(600 << 10)(1: Byte))
      )
      assert(clue(refusal(more)).contains("goes on after"))
      assertEquals(taken((_, _) => Left(NotFetched.CutOff)), Left(NotFetched.CutOff))

  test("a jar that was changed where it is kept comes again"):
    shipped(jar(1, short)): shipment =>
      val by                  = accepting(shipment.program.digest)()
      def classPath           = by.fetch(shipment.program.digest, _ => ())(honest(shipment)).map(_.classPath)
      val Right(Vector(file)) = classPath: @unchecked
      Files.write(file, Array.fill[Byte](short)(1))
      assertEquals(classPath, Right(Vector(file)))
      assertEquals(Sha256.of(file), shipment.program.jars.head.sha256)

  test("a list that no program has is refused in a line, even if its digest was accepted"):
    val some  = Jar(Sha256.of(Array[Byte](1)), 7)
    def lists = Seq(
      ""                                                             -> "expected 'skein program 1'",
      String(Program("-Dshort", Vector(some)).text, "UTF-8")         -> "the name of a class",
      String(Program("a b", Vector(some)).text, "UTF-8")             -> "the name of a class",
      String(Program("Main", Vector.fill(3000)(some)).text, "UTF-8") -> "at most 2048 jars",
      String(
        Program("Main", Vector.fill(4)(some.copy(bytes = Program.MostBytes / 2))).text,
        "UTF-8"
      )                                                                    -> "came 2048 MiB",
      String(Program("Main", Vector(some.copy(bytes = -1))).text, "UTF-8") -> "a jar's size",
      "skein program 1\nMain\n../../jar 7\n"                               -> "expected a SHA-256",
      "skein program 1\nMain\njar\n"                                       -> "a jar's SHA-256 and size"
    )
    for (list, told) <- lists do
      val bytes = list.getBytes("UTF-8")
      val came  =
        accepting(Sha256.of(bytes))().fetch(Sha256.of(bytes), _ => ())((_, _) => Right(ArraySeq.from(bytes)))
      assert(refusal(came).contains(told), s"$list: ${refusal(came)}")

  test("what is no jar of the program is not given, whatever offset is asked for"):
    val file = jar(1, short)
    shipped(file): shipment =>
      val own = shipment.program.jars.head.sha256
      assertEquals(shipment.piece(Sha256.of(Array[Byte](9)), 0), Right(ArraySeq.empty[Byte]))
      for offset <- Seq(-1L, Long.MinValue, short.toLong, Long.MaxValue) do
        assertEquals(shipment.piece(own, offset), Right(ArraySeq.empty[Byte]), offset.toString)
      Files.delete(file)
      assert(shipment.piece(own, 0).isLeft)
