package skein.cluster.jars

import java.io.IOException
import java.nio.ByteBuffer
import java.nio.channels.FileChannel
import java.nio.file.{Files, Path}
import scala.collection.immutable.ArraySeq
import scala.util.Using

/** A program whose bytes others may have, in pieces that they ask for.
  *
  * @param files of its jars
  * @param made jars of folders, deleted at the end
  */
final class Shipment private (val program: Program, files: Map[Sha256, Path], made: Vector[Path])
    extends AutoCloseable:

  /** What begins at an offset of a jar, or of the program's own text; nothing where that has no such bytes.
    *
    * @return or why it cannot be read
    */
  private[cluster] def piece(content: Sha256, offset: Long): Either[String, ArraySeq[Byte]] =
    if content == program.digest then
      Right(ArraySeq.unsafeWrapArray(program.text.drop(offset.max(0).min(program.text.length).toInt)))
    else
      files.get(content).filter(_ => offset >= 0).fold(Right(ArraySeq.empty[Byte])): file =>
        try
          Using.resource(FileChannel.open(file)): channel =>
            val bytes = ByteBuffer.allocate((channel.size - offset).max(0).min(Shipment.MostPiece).toInt)
            while bytes.hasRemaining && channel.read(bytes, offset + bytes.position()) >= 0 do ()
            Right(ArraySeq.unsafeWrapArray(bytes.array.take(bytes.position())))
        catch case failed: IOException => Left(s"cannot read $file: $failed")

  def close(): Unit = made.foreach(Files.deleteIfExists(_): Unit)

object Shipment:
  /** A message takes it. */
  private[cluster] val MostPiece = 512 << 10

  /** A program of what this process runs by. Reads all of it.
    *
    * @param main the class whose `main` starts the commands
    */
  def of(main: String, classPath: Vector[Path] = ClassPath.current): Either[String, Shipment] =
    val made = Vector.newBuilder[Path]
    try
      val files = classPath.map: part =>
        if !Files.isDirectory(part) then part
        else
          val jar = Files.createTempFile("skein-classes", ".jar")
          made += jar
          Using.resource(Files.newOutputStream(jar))(ClassPath.write(part, _))
          jar
      val jars     = files.map(ClassPath.jar)
      val shipment = Shipment(Program(main, jars), jars.map(_.sha256).zip(files).toMap, made.result())
      // What nobody could read is not offered.
      Program.read(shipment.program.text).map(_ => shipment).left.map: wrong =>
        shipment.close()
        s"this program cannot be shipped: $wrong"
    catch
      case failed: IOException =>
        made.result().foreach(Files.deleteIfExists(_): Unit)
        Left(s"this program cannot be shipped: $failed")
