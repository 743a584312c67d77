"""Prints reference.rs: what SciPy makes of the input of the tests."""
import numpy as np
import scipy
import scipy.signal as ss
from scipy.interpolate import make_smoothing_spline
print('//! Reference values of SciPy', scipy.__version__)
n=64; i=np.arange(n); x=np.sin(0.37*i)+0.5*np.cos(2.1*i)+0.01*i*i/10
def arr(name,v): print(f'pub const {name}: [f64; {len(v)}] = [\n    '+', '.join(repr(float(t)) for t in v)+',\n];')
for name,args in {'LOW_4':(4,0.2,'lowpass'),'LOW_3':(3,0.35,'lowpass'),'HIGH_2':(2,0.1,'highpass'),'HIGH_5':(5,0.15,'highpass'),'BAND_2':(2,[0.1,0.4],'bandpass'),'BAND_3':(3,[0.05,0.6],'bandpass')}.items():
    sos=ss.butter(args[0],args[1],args[2],output='sos')
    arr(name, ss.sosfiltfilt(sos,x))
for name,(w,o,d) in {'SAVGOL_11_2_0':(11,2,0),'SAVGOL_11_2_1':(11,2,1),'SAVGOL_9_3_0':(9,3,0),'SAVGOL_15_4_2':(15,4,2)}.items():
    arr(name, ss.savgol_filter(x,w,o,deriv=d,delta=0.5,mode='interp'))
t=i*0.5+0.1*np.sin(i)
for lam in (0.01,1.0,100.0):
    sp=make_smoothing_spline(t,x,lam=lam)
    arr(f'SPLINE_{str(lam).replace(".","_")}', sp(t)); arr(f'SPLINE_RATE_{str(lam).replace(".","_")}', sp.derivative()(t))
y=np.sin(0.2*i)+0.1*np.cos(7.7*i*i)
sp=make_smoothing_spline(t,y); arr('SPLINE_GCV', sp(t))
