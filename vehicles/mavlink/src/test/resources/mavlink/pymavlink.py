"""One line a frame: name, signed or plain, the frame, then every field; floats as their 32 bits."""
import os,random,struct
os.environ['MAVLINK20']='1'
from pymavlink.dialects.v20 import common as m
ids=[0,1,2,20,21,22,23,24,30,31,32,33,41,42,43,44,45,46,47,49,51,73,75,76,77,82,84,85,86,111,147,148,242,244,245,253,331,93,107,113,115]
r=random.Random(1)
lim={'uint8_t':(0,255),'int8_t':(-128,127),'uint16_t':(0,65535),'int16_t':(-32768,32767),'uint32_t':(0,2**32-1),'int32_t':(-2**31,2**31-1),'uint64_t':(0,2**64-1),'int64_t':(-2**63,2**63-1)}
def val(t,zero):
    if t=='float': return 0.0 if zero else struct.unpack('<f',struct.pack('<f',r.uniform(-1e3,1e3)))[0]
    return 0 if zero else r.randint(*lim[t])
def show(t,v):
    if t=='char': return v.decode() if isinstance(v,bytes) else v
    if t=='float': return str(struct.unpack('<i',struct.pack('<f',v))[0])
    if t=='uint64_t': return str(v-2**64 if v>=2**63 else v)
    return str(v)
key=bytes(range(32))
for signed in (False,True):
    f=m.MAVLink(None,srcSystem=42,srcComponent=191)
    if signed:
        f.signing.secret_key=key; f.signing.link_id=7; f.signing.timestamp=1234567890123; f.signing.sign_outgoing=True
    for i in ids:
        c=m.mavlink_map[i]
        for variant in (range(3) if not signed else range(1)):
            n=len(c.fieldnames); zero_from=n if variant==0 else r.randint(0,n) if variant==1 else 0
            vals=[];shown=[]
            for k,(name,t) in enumerate(zip(c.fieldnames,c.fieldtypes)):
                a=c.array_lengths[c.ordered_fieldnames.index(name)]; z=k>=zero_from
                if t=='char': v=(''.join(r.choice('ABCDEFGHIJ_0123') for _ in range(0 if z else r.randint(1,a)))).encode()
                elif a: v=[val(t,z) for _ in range(a)]
                else: v=val(t,z)
                vals.append(v); shown.append(','.join(show(t,x) for x in v) if a and t!='char' else show(t,v))
            msg=c(*vals); b=msg.pack(f); f.seq=(f.seq+1)%256
            print(c.msgname,'signed' if signed else 'plain',b.hex(),*[s or '-' for s in shown],sep=' ')
