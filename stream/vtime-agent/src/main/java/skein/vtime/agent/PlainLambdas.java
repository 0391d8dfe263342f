package skein.vtime.agent;

import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.charset.StandardCharsets;
import java.util.stream.IntStream;

/**
 * Makes the lambdas of a class file ordinary ones, which are no longer {@link java.io.Serializable}.
 *
 * <p>Scala links each lambda by {@code LambdaMetafactory.altMetafactory}. An ahead-of-time cache of JDK 25
 * contains only lambdas that are linked by {@code metafactory}; all others are generated again at each start.
 * Only the bootstrap methods are edited, by which lambdas are linked: no code, and so no stack map frame.
 */
final class PlainLambdas {
  private static final String FACTORY_TYPE =
      "(Ljava/lang/invoke/MethodHandles$Lookup;Ljava/lang/String;Ljava/lang/invoke/MethodType;"
          + "Ljava/lang/invoke/MethodType;Ljava/lang/invoke/MethodHandle;Ljava/lang/invoke/MethodType;)"
          + "Ljava/lang/invoke/CallSite;";

  /** Number of constants that are added to a class. */
  private static final int ADDED = 5;

  /** One more than the largest number of constants of a class file. */
  private static final int MOST = 65_535;

  /** Bits of the flags, which are an argument of {@code altMetafactory}. */
  private static final int MARKERS = 2;

  private static final int BRIDGES = 4;

  private final ByteBuffer file;
  private final int[] constants;
  private final int constantsEnd;
  private int metafactoryOwner;
  private boolean hasChanged;

  private PlainLambdas(byte[] bytes) {
    file = ByteBuffer.wrap(bytes);
    file.position(8);
    constants = new int[unsigned()];
    for (int i = 1; i < constants.length; i++) {
      constants[i] = file.position();
      var tag = file.get();
      switch (tag) {
        case 1 -> skip(unsigned());
        case 7, 8, 16, 19, 20 -> skip(2);
        case 15 -> skip(3);
        case 5, 6 -> {
          skip(8);
          i++; // takes the places of two
        }
        default -> skip(4);
      }
    }
    constantsEnd = file.position();
  }

  /**
   * Rewrites a class, if it makes lambdas by {@code altMetafactory}.
   *
   * @return null if it remains as it is
   */
  static byte[] rewrite(byte[] bytes) {
    try {
      var lambdas = new PlainLambdas(bytes);
      return lambdas.constants.length + ADDED > MOST ? null : lambdas.rewritten();
    } catch (IOException impossible) {
      throw new AssertionError(impossible);
    }
  }

  private byte[] rewritten() throws IOException {
    skip(6); // access, class, superclass
    skip(2 * unsigned());
    for (int kind = 0; kind < 2; kind++) { // fields, methods
      for (int left = unsigned(); left > 0; left--) {
        skip(6);
        for (int attributes = unsigned(); attributes > 0; attributes--) skipAttribute();
      }
    }
    for (int attributes = unsigned(); attributes > 0; attributes--) {
      var start = file.position();
      if (text(file.getShort(start)).equals("BootstrapMethods")) {
        skip(6);
        var table = plain();
        return hasChanged ? assembled(start, table) : null;
      }
      skipAttribute();
    }
    return null;
  }

  /** Reads the table of bootstrap methods, with those of lambdas replaced where possible. */
  private byte[] plain() throws IOException {
    var bytes = new ByteArrayOutputStream();
    var table = new DataOutputStream(bytes);
    var methods = unsigned();
    table.writeShort(methods);
    for (int i = 0; i < methods; i++) {
      var handle = unsigned();
      var arguments = IntStream.range(0, unsigned()).map(at -> unsigned()).toArray();
      var isPlain = isAltMetafactory(handle) && isReplaceable(arguments);
      hasChanged |= isPlain;
      var kept = isPlain ? 3 : arguments.length;
      table.writeShort(isPlain ? constants.length + ADDED - 1 : handle);
      table.writeShort(kept);
      for (int at = 0; at < kept; at++) table.writeShort(arguments[at]);
    }
    return bytes.toByteArray();
  }

  private boolean isAltMetafactory(int handle) {
    var method = constants[unsigned(constants[handle] + 2)];
    var name = unsigned(constants[unsigned(method + 3)] + 1);
    if (!text(name).equals("altMetafactory")) return false;
    metafactoryOwner = unsigned(method + 1);
    return true;
  }

  /**
   * Whether the lambda needs nothing of {@code altMetafactory}. A bridge of the lambda's own type is only for
   * reflection, by structural types.
   *
   * @param arguments the arguments' indices: type of the method, implementation, type of the lambda, flags;
   *     the number of bridges, and their types
   */
  private boolean isReplaceable(int[] arguments) {
    var flags = file.getInt(constants[arguments[3]] + 1);
    return (flags & MARKERS) == 0
        && ((flags & BRIDGES) == 0
            || IntStream.range(5, arguments.length).allMatch(at -> arguments[at] == arguments[2]));
  }

  /** Combines the class with {@code metafactory} as its last constant, and the new table. */
  private byte[] assembled(int attribute, byte[] table) throws IOException {
    var bytes = new ByteArrayOutputStream();
    var out = new DataOutputStream(bytes);
    var next = constants.length;
    out.write(file.array(), 0, 8);
    out.writeShort(next + ADDED);
    out.write(file.array(), 10, constantsEnd - 10);
    out.writeByte(1);
    out.writeUTF("metafactory");
    out.writeByte(1);
    out.writeUTF(FACTORY_TYPE);
    out.writeByte(12); // name and type
    out.writeShort(next);
    out.writeShort(next + 1);
    out.writeByte(10); // method
    out.writeShort(metafactoryOwner);
    out.writeShort(next + 2);
    out.writeByte(15); // handle
    out.writeByte(6); // of a static method
    out.writeShort(next + 3);
    out.write(file.array(), constantsEnd, attribute + 2 - constantsEnd);
    out.writeInt(table.length);
    out.write(table);
    out.write(file.array(), file.position(), file.remaining());
    return bytes.toByteArray();
  }

  private void skipAttribute() {
    skip(2);
    skip(file.getInt());
  }

  private void skip(int bytes) {
    file.position(file.position() + bytes);
  }

  private int unsigned() {
    return Short.toUnsignedInt(file.getShort());
  }

  private int unsigned(int at) {
    return Short.toUnsignedInt(file.getShort(at));
  }

  private String text(int constant) {
    var at = constants[constant & 0xffff];
    return new String(file.array(), at + 3, unsigned(at + 1), StandardCharsets.UTF_8);
  }
}
